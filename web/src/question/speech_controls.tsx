// Hearing the question and answering it by voice: a switch here, the code when it is switched on.
import type { Question } from "../state/questions";
import { keys, keysOn } from "../state/preferences";
import { repeat } from "./repeating";

export function SpeechControls({ question, onAct }: { question: Question; onAct(): void }) {
  return (
    <div class="speech">
      <button
        type="button"
        class="button"
        onClick={() => {
          onAct();
          repeat(question);
        }}
      >
        Repeat
        {keysOn.value && keys.value.repeat !== "" && <kbd aria-hidden="true">{keys.value.repeat.toUpperCase()}</kbd>}
      </button>
    </div>
  );
}

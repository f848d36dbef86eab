// Hearing the question and answering it by voice: a switch here, the code when it is switched on.
import { useState } from "preact/hooks";
import { may } from "../state/access";
import { keys, keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import { lastHeard, listensTo, type SpeechPhase, speechLacks, speechPhase } from "../speech/speech_state";
import { switchOff, switchOn } from "../speech/speech_switch";
import { repeat } from "./repeating";
import { t } from "../words/words";
import "./speech_controls.css";

const PHASES: Readonly<Record<SpeechPhase, string>> = {
  off: "",
  starting: t("Starting …"),
  idle: t("Ready to speak"),
  speaking: t("The robot speaks"),
  listening: t("Speak now: yes or no"),
  hearing: t("Listening to you …"),
  gave_up: t("Not understood. Please use the buttons."),
};

export function SpeechControls({ question, onAct }: { question: Question; onAct(): void }) {
  const [failed, setFailed] = useState(false);
  const phase = speechPhase.value;
  const on = phase !== "off";
  const toggle = () => {
    onAct();
    setFailed(false);
    if (on) switchOff();
    else switchOn().catch(() => setFailed(true));
  };
  const heard = lastHeard.value;
  return (
    <div class="speech">
      {may("helper") && (
        <button type="button" class="button mic" aria-pressed={on} onClick={toggle}>
          <svg viewBox="0 0 20 20" width="20" height="20" aria-hidden="true">
            <rect x="7" y="2" width="6" height="10" rx="3" />
            <path d="M4 9.5a6 6 0 0 0 12 0M10 15.5V18" />
          </svg>
          {t("Listen and speak")}
        </button>
      )}
      <button
        type="button"
        class="button"
        onClick={() => {
          onAct();
          repeat(question);
        }}
      >
        {t("Repeat")}
        {keysOn.value && keys.value.repeat !== "" && <kbd aria-hidden="true">{keys.value.repeat.toUpperCase()}</kbd>}
      </button>
      <p class={`speech-phase ${phase}`} role="status">
        {phase === "listening" && listensTo.value !== null
          ? t("Speak now, in {language}: “{yes}” or “{no}”", listensTo.value)
          : PHASES[phase]}
        {heard !== null && (
          <span class="heard">
            {heard.phrase === null ? t("That was no yes or no.") : t("Heard: “{phrase}”", { phrase: heard.phrase })}
          </span>
        )}
        {failed && t("The spoken side could not be loaded. Is the service there?")}
      </p>
      {speechLacks.value !== "" && <p class="speech-lacks small">{speechLacks.value}</p>}
    </div>
  );
}

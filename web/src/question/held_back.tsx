// A reply that cannot be taken back otherwise is held back for a moment, over what was chosen from.
import { held, undo } from "./answering";

export function HeldBack({ prompt }: { prompt: string }) {
  const waiting = held.value;
  if (waiting?.prompt !== prompt) return null;
  return (
    <div class="held-back">
      <p>
        <strong>{waiting.said}</strong> is sent in a moment
      </p>
      <button type="button" class="button" onClick={undo}>
        Undo <kbd aria-hidden="true">Esc</kbd>
      </button>
      <span class="held-progress" aria-hidden="true" />
    </div>
  );
}

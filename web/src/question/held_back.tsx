// A reply that cannot be taken back otherwise is held back for a moment, over what was chosen from.
import { held, undo } from "./answering";
import { parts, t } from "../words/words";

export function HeldBack({ prompt }: { prompt: string }) {
  const waiting = held.value;
  if (waiting?.prompt !== prompt) return null;
  return (
    <div class="held-back">
      <p>
        {parts("{reply} is sent in a moment", { reply: <strong>{waiting.said}</strong> })}
      </p>
      <button type="button" class="button" onClick={undo}>
        {t("Undo")} <kbd aria-hidden="true">{t("Esc")}</kbd>
      </button>
      <span class="held-progress" aria-hidden="true" />
    </div>
  );
}

// That no answer has come to what somebody asks for, and how it is asked for once more without being booked twice.
import type { Asking, RequestDocument } from "./use_asking";
import { t } from "../words/words";

interface UnansweredProps {
  asking: Asking;
  ask: (request: RequestDocument) => void;
}

export function Unanswered({ asking, ask }: UnansweredProps) {
  if (asking.phase === "sending") {
    return <p role="status">{asking.lost ? t("No answer has come. I try once more …") : ""}</p>;
  }
  if (asking.phase !== "unknown") return null;
  return (
    <div class="refused">
      <div role="alert">
        <p class="mistake">{notKnown()}</p>
        <p>{t("No answer has come. If you try once more it is booked only once, even if it was booked already.")}</p>
      </div>
      <button class="button primary" type="button" onClick={() => ask(asking.request)}>
        {t("Try once more")}
      </button>
    </div>
  );
}

/** The same for whoever hears it. */
export function notKnown(): string {
  return t("I do not know whether that was booked.");
}

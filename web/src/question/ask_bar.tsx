// On every other view: that a robot asks, and the way to its question.
import { route } from "../app/router";
import { fleetAt } from "../requests/fleets";
import { faultInWords, robotName } from "./fault_words";
import { isPutOff, putOffCalls, rings } from "../calling/calls";
import { shown } from "./queue";
import { questions } from "../state/questions";
import { t } from "../words/words";
import "./ask_bar.css";

export function AskBar() {
  const question = shown.value;
  const place = route.value;
  if (question === null || place.view === "questions") return null;
  // The run's own view shows its question itself.
  if (place.view === "run" && questions.value.every((each) => each.run === place.run)) return null;
  // So does that of the fleet whose robots alone ask.
  const fleet = place.view === "fleet" ? fleetAt(place.site) : null;
  if (fleet && questions.value.every((each) => fleet.robots.some(({ robot }) => robot === each.robot))) return null;
  const others = questions.value.length - 1;
  return (
    <aside class="ask-bar" aria-label={t("A robot asks")}>
      <p>
        <strong>{t("{robot} asks for help.", { robot: robotName(question.robot) })}</strong> {faultInWords(question)}
        {others > 0 && <span class="quiet"> {t("And {others} more.", { others })}</span>}
      </p>
      <div class="ask-bar-buttons">
        {rings.value.length > 0 && !isPutOff(question) && (
          <button type="button" class="button" onClick={() => putOffCalls(question)}>
            {t("Not me")}
          </button>
        )}
        <a class="button primary" href="/">
          {t("Answer")}
        </a>
      </div>
    </aside>
  );
}

// Says why a card has closed; the region is always there, so that it is read out.
import { dismissEnding, endings } from "../state/endings";
import { plain } from "../tree/words";
import { robotName } from "./fault_words";
import { t } from "../words/words";
import "./endings_list.css";

export function Endings({ run }: { run?: string }) {
  const told = endings.value.filter((each) => run === undefined || each.run === run);
  return (
    <div class="endings" role="status" aria-label={t("What became of questions")}>
      {told.map((each) => (
        <div key={each.id} class="ending">
          <p>
            <strong>
              {robotName(each.robot)}, {plain(each.about)}:
            </strong> {each.text}
          </p>
          <button type="button" class="button quiet-button" aria-label={t("Dismiss")} onClick={() => dismissEnding(each.id)}>
            ✕
          </button>
        </div>
      ))}
    </div>
  );
}

// On every view: that a robot is gone while a run waits for it, until somebody here says that they know.
import { robotName } from "../question/fault_words";
import { t, tn } from "../words/words";
import { knowOfMissed, missed } from "./calls";
import "./missed_bar.css";

export function MissedBar() {
  const gone = missed.value;
  const [first] = gone;
  return (
    <div class="missed-bar" role="status" aria-live="assertive">
      {first !== undefined && (
        <>
          <p>
            <strong>
              {gone.length === 1
                ? t("{robot} is gone, and its run waits for it.", { robot: robotName(first.robot) })
                : tn("One robot is gone, and its run waits for it.", "{count} robots are gone, and their runs wait for them.", { count: gone.length })}
            </strong>{" "}
            {t("See whether it has power and a connection.")}
          </p>
          <div class="missed-bar-buttons">
            <button type="button" class="button" onClick={knowOfMissed}>
              {t("I know")}
            </button>
            <a class="button" href={gone.length === 1 ? `/runs/${first.run}` : "/runs"}>
              {t("Show the run")}
            </a>
          </div>
        </>
      )}
    </div>
  );
}

// The runs that go on, those that ask first.
import { robotName } from "../question/fault_words";
import { STATUS_SIGNS, STATUS_WORDS } from "../run/run_words";
import { questions } from "../state/questions";
import { runs } from "../state/service";
import { plain } from "../tree/words";
import { t } from "../words/words";
import { HomeList } from "./home_list";

export function RunsGoingOn() {
  const asking = new Set(questions.value.map(({ run }) => run));
  const going = [...runs.value.values()]
    .filter(({ status }) => status === "running" || status === "paused")
    .sort((one, other) => Number(asking.has(other.id)) - Number(asking.has(one.id)) || Date.parse(other.started) - Date.parse(one.started));
  if (going.length === 0) return null;
  return (
    <HomeList
      id="home-runs"
      title={t("Runs that go on")}
      href="/runs"
      all={t("All runs")}
      items={going.map((run) => (
        <li key={run.id}>
          <a href={`/runs/${run.id}`}>{plain(run.tree)}</a>
          <span class="home-state">
            {asking.has(run.id) ? (
              <strong class="home-asks">{t("Asks a question")}</strong>
            ) : (
              <>
                <span aria-hidden="true">{STATUS_SIGNS[run.status]}</span> {STATUS_WORDS[run.status]}
              </>
            )}
          </span>
          <span class="small quiet">{[run.world, ...run.robots.map(robotName)].join(" · ")}</span>
        </li>
      ))}
    />
  );
}

// The robots that are gone and the runs that have failed, until somebody has looked at them.
import { ago, outcome, sentence } from "../run/run_words";
import { noteKnown } from "../state/failures";
import { useNow } from "../state/use_now";
import { plain, withoutRun } from "../tree/words";
import type { RobotView, RunSummary } from "../wire/types";
import type { Glance } from "./glance";
import { parts, t } from "../words/words";
import "./at_fault.css";

const SHOWN_AT_MOST = 5;

export function AtFault({ glance: { failures, lost } }: { glance: Glance }) {
  const now = useNow();
  return (
    <ul class="at-fault">
      {lost.map((each) => (
        <Lost key={each.robot} robot={each} />
      ))}
      {failures.slice(0, SHOWN_AT_MOST).map((each) => (
        <Failure key={each.id} run={each} now={now} />
      ))}
      {failures.length > SHOWN_AT_MOST && (
        <li>
          <a href="/runs">{t("And {count} more runs have failed.", { count: failures.length - SHOWN_AT_MOST })}</a>
        </li>
      )}
    </ul>
  );
}

function Lost({ robot }: { robot: RobotView }) {
  return (
    <li>
      <a href={`/runs/${robot.run}`}>
        {parts("{robot} is gone, and its run waits for it.", { robot: <strong>{withoutRun(robot.robot)}</strong> })}
      </a>
    </li>
  );
}

function Failure({ run, now }: { run: RunSummary; now: number }) {
  const told = { tree: <strong>{plain(run.tree)}</strong>, ago: ago(Date.parse(run.ended ?? run.started), now) };
  return (
    <li>
      <a href={`/runs/${run.id}`}>
        {run.status === "failed" ? parts("{tree} failed {ago}.", told) : parts("{tree} cannot be read {ago}.", told)} {run.result !== null && sentence(outcome(run))}
      </a>
      <button type="button" class="button" aria-label={t("Put aside: {tree}", { tree: plain(run.tree) })} onClick={() => noteKnown(run.id)}>
        ✕
      </button>
    </li>
  );
}

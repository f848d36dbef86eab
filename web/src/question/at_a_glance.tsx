// Where no robot asks anything: whether the runs go on, what has failed, and which robots are gone.
import { useEffect, useState } from "preact/hooks";
import { fleets } from "../requests/fleets";
import { ago, outcome, sentence } from "../run/run_words";
import { noteKnown } from "../state/failures";
import { knownFailures } from "../state/preferences";
import { connection, onEvent, onSnapshot, runs, runsRead, trouble } from "../state/service";
import { useNow } from "../state/use_now";
import { plain, withoutRun } from "../tree/words";
import * as rest from "../wire/rest";
import type { Event, RobotView, RunSummary } from "../wire/types";
import { glanceOf, type Sign } from "./glance";
import { parts, t } from "../words/words";
import "./at_a_glance.css";

const SHOWN_AT_MOST = 5;
const COMES_OR_GOES: ReadonlySet<Event["type"]> = new Set(["robot_lost", "robot_back", "run_started"]);

const SIGNS: Readonly<Record<Sign, string>> = {
  well: "m14 25 7 7 13-15",
  idle: "M14 24h20",
  bad: "M24 12v15M24 33v2",
  unknown: "M18 19a6 6 0 1 1 8.500 5.500c-2 1-2.500 2-2.500 4M24 34v1",
};

export function AtAGlance() {
  const robots = useRobots();
  const now = useNow();
  const seen = { connection: connection.value, trouble: trouble.value, known: knownFailures.value };
  const { sign, words, more, failures, lost } = glanceOf({
    ...seen,
    runs: runsRead.value ? [...runs.value.values()] : null,
    robots,
    ofFleets: new Set(fleets.value?.flatMap((site) => site.robots.map(({ robot }) => robot))),
    now,
  });
  return (
    <div class="glance">
      <svg class={sign} viewBox="0 0 48 48" width="64" height="64" aria-hidden="true">
        <circle cx="24" cy="24" r="21" />
        <path d={SIGNS[sign]} />
      </svg>
      <p class="glance-words">{words}</p>
      {failures.length + lost.length > 0 && (
        <ul class="glance-bad">
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
      )}
      <p class="quiet">{more} {t("This page tells you when a robot asks. You can leave it open and do something else.")}</p>
    </div>
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

/** All robots; none where this helper may not see them. */
function useRobots(): readonly RobotView[] {
  const [robots, setRobots] = useState<readonly RobotView[]>([]);
  useEffect(() => {
    let current = true;
    const read = () => void rest.robots().then((found) => current && setRobots(found), () => undefined);
    const stop = [onSnapshot(read), onEvent((event) => COMES_OR_GOES.has(event.type) && read())];
    read();
    return () => {
      current = false;
      stop.forEach((each) => each());
    };
  }, []);
  return robots;
}

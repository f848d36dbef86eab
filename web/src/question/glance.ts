// What there is to say where no robot asks anything: nothing is called well that is not seen to be.
import type { ConnectionState } from "../wire/helper_socket";
import type { RobotView, RunSummary } from "../wire/types";
import { t, tn } from "../words/words";

const FRESH_MS = 24 * 3_600_000;

export type Sign = "well" | "idle" | "bad" | "unknown";

export interface Glance {
  readonly sign: Sign;
  readonly words: string;
  /** What else there is to know, in a sentence. */
  readonly more: string;
  /** Runs that ended badly, which nobody here has looked at. */
  readonly failures: readonly RunSummary[];
  /** Robots that runs wait for. */
  readonly lost: readonly RobotView[];
  /** Runs that wait to be let go. */
  readonly waiting: readonly RunSummary[];
}

export interface Seen {
  readonly connection: ConnectionState;
  /** Why the service cannot keep what happens; null while it can. */
  readonly trouble: string | null;
  /** The newest runs, and those that go on; null until they were read. */
  readonly runs: readonly RunSummary[] | null;
  readonly robots: readonly RobotView[];
  /** Robots of fleets: what they fail at their fleet gives to others, and its page tells. */
  readonly ofFleets: ReadonlySet<string>;
  readonly known: readonly string[];
  readonly now: number;
}

export function glanceOf({ connection, trouble, runs, robots, ofFleets, known, now }: Seen): Glance {
  if (connection !== "connected" || runs === null) {
    const more = connection === "connected" ? t("Reading what the runs do.") : t("Questions may wait that are not seen here.");
    return { sign: "unknown", words: t("Not known whether a robot asks anything."), more, failures: [], lost: [], waiting: [] };
  }
  const goingOn = runs.filter(({ status }) => status === "running" || status === "paused");
  const failures = runs.filter(
    (each) =>
      hasJustFailed(each, now) && !known.includes(each.id) && !each.robots.some((robot) => ofFleets.has(robot)),
  );
  const waitedFor = new Set(goingOn.map(({ id }) => id));
  const lost = robots.filter(({ state, run }) => state === "lost" && run !== null && waitedFor.has(run));
  const waiting = goingOn.filter(({ waits }) => waits.length > 0);
  const more = goingOnWords(goingOn);
  if (failures.length + lost.length > 0 || trouble !== null) {
    return { sign: "bad", words: t("No robot asks anything, but not all is well."), more, failures, lost, waiting };
  }
  if (waiting.length > 0) {
    return { sign: "bad", words: t("No robot asks anything, but one waits to be let go."), more, failures, lost, waiting };
  }
  const sign = goingOn.length > 0 ? "well" : "idle";
  return { sign, words: t("No robot asks anything."), more, failures, lost, waiting };
}

/** Whether a run has ended badly within a day. */
function hasJustFailed({ status, ended }: RunSummary, now: number): boolean {
  return (status === "failed" || status === "unreadable") && (ended === null || now - Date.parse(ended) < FRESH_MS);
}

function goingOnWords(runs: readonly RunSummary[]): string {
  if (runs.length === 0) return t("No run goes on.");
  const paused = runs.filter(({ status }) => status === "paused").length;
  const all = tn("One run goes on", "{count} runs go on", { count: runs.length });
  if (paused === 0) return `${all}.`;
  return runs.length === paused ? t("{all}, paused.", { all }) : t("{all}, {paused} of them paused.", { all, paused });
}

// What is known of each robot at the moment that is shown, for words and lists: it changes rarely.
import { shortened } from "../tree/words";
import { type Activity, activityOf, type AtWork, doingInWords } from "./at_work";
import type { Plan } from "./plan";
import { howLong, type Standing } from "./standing";
import { floorShownAt, whereInWords } from "./whereabouts";
import { t } from "../words/words";

/** So much of a goal's name is under that of a robot; all of it is in the list. */
const GOAL_CHARACTERS = 18;

export interface SeenRobot {
  readonly robot: string;
  readonly name: string;
  readonly activity: Activity;
  /** The floor on which it is drawn; null where nothing is known of it. */
  readonly floor: string | null;
  /** "on F2, near 204", as it is or was. */
  readonly where: string | null;
  readonly doing: string;
  /** What is under its name on the plan. */
  readonly short: string;
  /** "last seen 12 s ago"; null while it is seen. */
  readonly unseen: string | null;
}

interface About {
  readonly plan: Plan;
  /** Whether what is shown is a moment of the past. */
  readonly past: boolean;
  /** Whether nobody can say since when nothing has come. */
  readonly atLeast: boolean;
}

export function seenRobots(
  robots: readonly AtWork[],
  standings: readonly (Standing | null)[],
  about: About,
): readonly SeenRobot[] {
  return robots.map((robot, index) => seenRobot(robot, standings[index] ?? null, about));
}

function seenRobot(robot: AtWork, standing: Standing | null, { plan, past, atLeast }: About): SeenRobot {
  const activity = activityOf(robot, standing?.moving ?? false);
  const floor = standing === null ? null : floorShownAt(plan, standing.z).name;
  const unseen = standing === null ? null : unseenSince(robot, standing, past, atLeast);
  return {
    robot: robot.robot,
    name: robot.name,
    activity,
    floor,
    where: standing === null ? null : whereInWords(plan, standing),
    doing: doingInWords(robot, activity, floor),
    short: unseen ?? shortly(robot, activity),
    unseen,
  };
}

function unseenSince(robot: AtWork, { seen_s }: Standing, past: boolean, atLeast: boolean): string | null {
  if (seen_s === null) return robot.lost && !past ? t("connection lost") : null;
  const since = atLeast ? t("more than {duration}", { duration: howLong(seen_s) }) : howLong(seen_s);
  return past ? t("last seen {since} before", { since }) : t("last seen {since} ago", { since });
}

function shortly({ goal, task }: AtWork, activity: Activity): string {
  const there = goal === null ? "" : ` → ${shortened(goal.name, GOAL_CHARACTERS)}`;
  if (activity === "asking") return t("asks");
  if (task === "helped") return t("waits for help");
  if (activity === "idle") return "";
  return activity === "driving" ? there.trim() : `${t("waits")}${there}`;
}

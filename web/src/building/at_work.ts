// What each robot of a run is at, as its events tell: to where it drives, and whether it asks.
import { robotName } from "../question/fault_words";
import { ended, type RunState } from "../run/fold";
import { plain } from "../tree/words";
import { type Plan, scenePlace } from "./plan";
import { floorOn, nearestPlace, type Point } from "./whereabouts";
import { t } from "../words/words";

export type Activity = "driving" | "waiting" | "asking" | "idle";

export interface Goal extends Point {
  /** As the building calls it, or the scene. */
  readonly name: string;
  readonly floor: string | null;
}

export interface AtWork {
  readonly robot: string;
  readonly name: string;
  readonly task: "working" | "held" | "asking" | "helped" | "idle" | "over";
  /** The leaf that it does. */
  readonly leaf: string | null;
  readonly goal: Goal | null;
  /** Whether the service has lost it. */
  readonly lost: boolean;
}

/** The robots of a run, in its order. */
export function robotsAtWork(state: RunState, plan: Plan): readonly AtWork[] {
  const talks = [...state.dialogues.values()];
  return state.started.robots.map((robot) => {
    const execution = state.executions.get(robot);
    const talk = talks.find(({ opened }) => opened.robot === robot);
    return {
      robot,
      name: robotName(robot),
      task: taskOf(state, execution?.held, talk === undefined ? undefined : talk.helpAwaited !== null),
      leaf: execution === undefined ? null : plain(execution.name),
      goal: execution === undefined ? null : goalOf(state, plan, execution.node),
      lost: state.lost.has(robot),
    };
  });
}

function taskOf(state: RunState, held: boolean | undefined, helped: boolean | undefined): AtWork["task"] {
  if (ended(state.status)) return "over";
  if (helped !== undefined) return helped ? "helped" : "asking";
  if (held === undefined) return "idle";
  return held ? "held" : "working";
}

function goalOf(state: RunState, plan: Plan, node: string): Goal | null {
  const index = state.shape.indices.get(node);
  const place = index === undefined ? undefined : state.shape.definitions[index]?.parameters?.place;
  if (typeof place !== "string") return null;
  const pose = scenePlace(state.started.scene, place);
  if (pose === null) return null;
  const floor = floorOn(plan, pose.z);
  const near = floor === null ? null : nearestPlace(floor, pose);
  const same = near !== null && Math.hypot(near.x - pose.x, near.y - pose.y) < 0.01;
  return { ...pose, name: same ? near.name : plain(place), floor: floor?.name ?? null };
}

/** What a robot does, where it moves or stands. */
export function activityOf({ task }: AtWork, moving: boolean): Activity {
  if (task === "asking") return "asking";
  if (task === "idle" || task === "over") return "idle";
  return task === "working" && moving ? "driving" : "waiting";
}

export const ACTIVITY_WORDS: Readonly<Record<Activity, string>> = {
  driving: t("Driving"),
  waiting: t("Waiting"),
  asking: t("Asking"),
  idle: t("Idle"),
};

/** Beside the word and the colour, for those who do not tell colours. */
export const ACTIVITY_SIGNS: Readonly<Record<Activity, string>> = {
  driving: "▶",
  waiting: "‖",
  asking: "?",
  idle: "■",
};

/** "drives to 101", as a clause after its name. */
export function doingInWords(robot: AtWork, activity: Activity, here: string | null): string {
  const { goal, leaf, task } = robot;
  const there = goal === null ? (leaf ?? t("its goal")) : toGoal(goal, here);
  if (task === "over") return t("has ended its work");
  if (activity === "idle") return t("has nothing to do");
  if (activity === "asking") return t("asks, on its way to {there}", { there });
  if (task === "helped") return t("waits for help, on its way to {there}", { there });
  return activity === "driving" ? t("drives to {there}", { there }) : t("waits on its way to {there}", { there });
}

/** A goal by its name, and its floor where that is another one. */
export function toGoal({ name, floor }: Goal, here: string | null): string {
  return floor === null || floor === here ? name : t("{name} on {floor}", { name, floor });
}

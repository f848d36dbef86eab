// How a robot stands, and which of several somebody has to see after first.
import type { RobotView } from "../wire/types";

export type Standing = "lost" | "asking" | "holding" | "working" | "idle";

const ORDER: readonly Standing[] = ["lost", "asking", "holding", "working", "idle"];

export function standingOf({ robot, state }: RobotView, asking: ReadonlySet<string>): Standing {
  return state !== "lost" && asking.has(robot) ? "asking" : state;
}

export function robotsInOrder(robots: readonly RobotView[], asking: ReadonlySet<string>): RobotView[] {
  const rank = (robot: RobotView) => ORDER.indexOf(standingOf(robot, asking));
  return [...robots].sort((one, other) => rank(one) - rank(other) || one.robot.localeCompare(other.robot));
}

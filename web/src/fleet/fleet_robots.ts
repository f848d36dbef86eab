// The robots of a fleet as plans draw them: where each says that it is, and what it is at.
import type { AtWork, Goal } from "../building/at_work";
import { type Plan, placeOf } from "../building/plan";
import type { Standing } from "../building/standing";
import { robotName } from "../question/fault_words";
import type { FleetRobot, FleetView } from "../wire/types";

/** What robots were last heard of so long ago (the site's clock, s), while they are at work, is old. */
const OLD_S = 10;
const MOVED_M = 0.05;

export type Asking = ReadonlyMap<string, "asking" | "helped">;

export function fleetAtWork(fleet: FleetView, plan: Plan, asking: Asking): readonly AtWork[] {
  return fleet.robots.map((robot) => ({
    robot: robot.robot,
    name: robotName(robot.robot),
    task: asking.get(robot.robot) ?? (robot.at_work === null ? "idle" : "working"),
    leaf: robot.at_work?.request ?? null,
    goal: goalOf(robot, plan),
    lost: !robot.connected,
  }));
}

function goalOf({ at_work }: FleetRobot, plan: Plan): Goal | null {
  const place = at_work === null ? null : placeOf(plan, at_work.place);
  return place === null ? null : { x: place.x, y: place.y, z: place.z, name: place.name, floor: place.floor };
}

/** Where robots say that they are; `before` are those of the last reading, to tell who moves. */
export function standingsOf(fleet: FleetView, before: ReadonlyMap<string, Standing>): ReadonlyMap<string, Standing> {
  return new Map(
    fleet.robots.flatMap(({ robot, pose, at_work, connected }) => {
      if (pose === null) return [];
      const { x, y, z, yaw, covariance } = pose;
      const was = before.get(robot);
      const moving = was !== undefined && Math.hypot(was.x - x, was.y - y) + Math.abs(was.z - z) > MOVED_M;
      // Who has nothing to do stands where it was, whatever the time.
      const old = !connected || (at_work !== null && pose.age_s > OLD_S);
      const standing: Standing = { x, y, z, yaw, moving, seen_s: old ? pose.age_s : null, covariance };
      return [[robot, standing] as const];
    }),
  );
}

// The robots of a fleet as plans draw them: where each says that it is, and what it is at.
import type { AtWork, Goal } from "../building/at_work";
import { type Plan, placeOf } from "../building/plan";
import type { Standing } from "../building/standing";
import { robotName } from "../question/fault_words";
import type { FleetLeg, FleetView } from "../wire/types";

/** What robots were last heard of so long ago (the site's clock, s), while they are at work, is old. */
export const OLD_S = 10;
const MOVED_M = 0.05;

export type Asking = ReadonlyMap<string, "asking" | "helped">;

export function fleetAtWork(fleet: FleetView, plan: Plan, asking: Asking): readonly AtWork[] {
  return fleet.robots.map(({ robot, at_work, connected }) => atWork(robot, at_work, plan, asking.get(robot), !connected));
}

/** What robots were at in the past; whom they asked then their runs tell. */
export function fleetAtWorkThen(fleet: FleetView, plan: Plan, legs: ReadonlyMap<string, FleetLeg>): readonly AtWork[] {
  return fleet.robots.map(({ robot }) => atWork(robot, legs.get(robot) ?? null, plan, undefined, false));
}

function atWork(robot: string, leg: FleetLeg | null, plan: Plan, asks: "asking" | "helped" | undefined, lost: boolean): AtWork {
  const task = asks ?? (leg === null ? "idle" : "working");
  return { robot, name: robotName(robot), task, leaf: leg?.request ?? null, goal: goalOf(leg, plan), lost };
}

function goalOf(leg: FleetLeg | null, plan: Plan): Goal | null {
  const place = leg === null ? null : placeOf(plan, leg.place);
  return place === null ? null : { x: place.x, y: place.y, z: place.z, name: place.name, floor: place.floor };
}

/** Where robots say that they are; `before` are those of the last reading, to tell who moves, and for `silent_s` nothing has come. */
export function standingsOf(fleet: FleetView, before: ReadonlyMap<string, Standing>, silent_s: number): ReadonlyMap<string, Standing> {
  return new Map(
    fleet.robots.flatMap(({ robot, pose, at_work, connected }) => {
      if (pose === null) return [];
      const { x, y, z, yaw, covariance } = pose;
      const was = before.get(robot);
      const moving = silent_s === 0 && was !== undefined && Math.hypot(was.x - x, was.y - y) + Math.abs(was.z - z) > MOVED_M;
      // Who has nothing to do stands where it was, whatever the time, as long as somebody can say that it is connected.
      const old = silent_s > 0 || !connected || (at_work !== null && pose.age_s > OLD_S);
      const standing: Standing = { x, y, z, yaw, moving, seen_s: old ? pose.age_s + silent_s : null, covariance };
      return [[robot, standing] as const];
    }),
  );
}

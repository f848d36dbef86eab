// What a pointer or keys do to a thing: another pose, or another size.
import type { Pose, Thing } from "./scene_source";

export interface ThingChange {
  pose?: Partial<Pose>;
  size?: readonly number[];
}

export const SMALLEST_M = 0.005;
const QUARTER = Math.PI / 2;
const STEP_RAD = (5 * Math.PI) / 180;
const SMALL_STEP_RAD = Math.PI / 180;

/** A part whose corner is at a point of the scene, turned and centred as it is; to a millimetre. */
export function resizedTo({ pose, size }: Thing, at: { x: number; y: number }): ThingChange {
  const [dx, dy] = [at.x - pose.x, at.y - pose.y];
  const [cos, sin] = [Math.cos(pose.yaw), Math.sin(pose.yaw)];
  return { size: [extent(dx * cos + dy * sin), extent(dy * cos - dx * sin), size?.[2] ?? SMALLEST_M] };
}

function extent(half: number): number {
  return Math.max(SMALLEST_M, Math.round(2000 * Math.abs(half)) / 1000);
}

/** A part that is so much deeper and wider, in metres. */
export function resizedBy({ size }: Thing, depth: number, width: number): ThingChange {
  const [x = 0, y = 0, z = 0] = size ?? [];
  return { size: [Math.max(SMALLEST_M, x + depth), Math.max(SMALLEST_M, y + width), z] };
}

/** Turned so that its front looks at a point: by steps of 5 degrees, or of one where `finely`; a robot by quarters. */
export function turnedTo({ kind, pose }: Thing, at: { x: number; y: number }, finely: boolean): ThingChange {
  const step = kind === "robot" ? QUARTER : finely ? SMALL_STEP_RAD : STEP_RAD;
  return { pose: { yaw: Math.round(Math.atan2(at.y - pose.y, at.x - pose.x) / step) * step } };
}

/** A thing as it is while another one is changed so, with which it may move, turn or grow. */
export function shownWith(thing: Thing, changed: Thing, { pose, size }: ThingChange): Thing {
  const together = thing.where !== null && thing.where.join("/") === changed.where?.join("/");
  const equal = thing.owner !== null && thing.owner.join("/") === changed.owner?.join("/");
  const by = { x: (pose?.x ?? changed.pose.x) - changed.pose.x, y: (pose?.y ?? changed.pose.y) - changed.pose.y };
  const moved = { ...thing.pose, x: thing.pose.x + by.x, y: thing.pose.y + by.y, yaw: pose?.yaw ?? thing.pose.yaw };
  return { ...thing, pose: together ? moved : thing.pose, size: size !== undefined && equal ? size : thing.size };
}

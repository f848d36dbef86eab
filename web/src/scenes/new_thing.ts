// A part or a place as it is offered to be added: with a name and at a spot that nothing has yet.
import type { RobotReach } from "../wire/types";
import type { SceneSource, Thing } from "./scene_source";

/** Names as the service takes them. */
export const NAME_PATTERN = "[A-Za-z][A-Za-z0-9_\\-]{0,63}";

const STEP_M = 0.05;
const BETWEEN_M = 0.03;

/** A place for a part that has none, else a name that no other of the kind has. */
export function nameFor(kind: "object" | "place", { things }: SceneSource, selected: Thing): string {
  const taken = new Set(things.flatMap((each) => (each.kind === kind ? [each.owner?.[1] ?? each.name] : [])));
  if (kind === "place") {
    const parts = [selected, ...things].filter((each) => each.kind === "object" && each.where?.[2] === "pose");
    const without = parts.find(({ name }) => !taken.has(name));
    if (without !== undefined) return without.name;
  }
  const stem = kind === "object" ? "part" : "place";
  for (let number = 1; ; number++) if (!taken.has(`${stem}_${number}`)) return `${stem}_${number}`;
}

/**
 * Where on the table something has room, in reach of a robot where that is known, the nearest to `near`.
 *
 * Parts are kept clear of parts, places of places; where all is full it is the middle of the table.
 */
export function freeSpot(
  kind: "object" | "place",
  size: readonly number[],
  { table, things }: SceneSource,
  reach: readonly RobotReach[],
  near: { x: number; y: number },
): { x: number; y: number } {
  const [x = 0, y = 0] = table.center;
  const half = halfOf(size);
  const inside = (extent = 0) => Math.max(0, Math.floor((extent / 2 - half) / STEP_M));
  const [rows, columns] = [inside(table.size[0]), inside(table.size[1])];
  const others = things.filter((each) => each.kind === kind);
  let best = { x, y };
  let least = Number.POSITIVE_INFINITY;
  for (let row = -rows; row <= rows; row++) {
    for (let column = -columns; column <= columns; column++) {
      const at = { x: x + row * STEP_M, y: y + column * STEP_M };
      if (others.some(({ pose, size: other }) => distance(pose, at) < half + halfOf(other ?? []) + BETWEEN_M)) continue;
      const cost = distance(near, at) + (reach.length === 0 || reach.some((each) => isWithin(each, at)) ? 0 : 100);
      if (cost < least) [best, least] = [at, cost];
    }
  }
  return best;
}

function halfOf(size: readonly number[]): number {
  return Math.hypot(size[0] ?? STEP_M, size[1] ?? STEP_M) / 2;
}

function isWithin({ x, y, min_m, max_m }: RobotReach, at: { x: number; y: number }): boolean {
  const far = distance({ x, y }, at);
  return far >= min_m && far <= max_m;
}

function distance(one: { x: number; y: number }, other: { x: number; y: number }): number {
  return Math.hypot(one.x - other.x, one.y - other.y);
}

// What keys do at a thing in the top view of a scene.
import type { Thing } from "./scene_source";
import { resizedBy, type ThingChange } from "./thing_change";

const STEP_M = 0.01;
const SMALL_STEP_M = 0.001;
const GROWS_M = 0.005;
const TURN_RAD = (5 * Math.PI) / 180;
const SMALL_TURN_RAD = Math.PI / 180;

/** Seen from above: up is forward (x), left is left (y). */
const WAYS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowUp: [1, 0],
  ArrowDown: [-1, 0],
  ArrowLeft: [0, 1],
  ArrowRight: [0, -1],
};
const TURNS: Readonly<Record<string, number>> = { q: 1, e: -1 };
const GOES: Readonly<Record<string, "next" | "previous" | "first" | "last">> = {
  PageDown: "next",
  PageUp: "previous",
  Home: "first",
  End: "last",
};

export type SceneAction = { change: ThingChange } | { go: "next" | "previous" | "first" | "last" } | { does: "add" | "remove" };

type Pressed = Pick<KeyboardEvent, "key" | "shiftKey" | "altKey" | "ctrlKey" | "metaKey">;

/** With Shift steps are small, with Alt a part grows. A robot's base turns by quarters. Null for keys that mean nothing here. */
export function sceneActionOf(event: Pressed, thing: Thing): SceneAction | null {
  if (event.ctrlKey || event.metaKey) return null;
  const way = WAYS[event.key];
  if (event.altKey) return way === undefined || thing.kind !== "object" ? null : { change: grown(thing, way, event.shiftKey) };
  const { pose } = thing;
  const step = event.shiftKey ? SMALL_STEP_M : STEP_M;
  if (way !== undefined) return { change: { pose: way[0] !== 0 ? { x: pose.x + way[0] * step } : { y: pose.y + way[1] * step } } };
  const turn = TURNS[event.key.toLowerCase()];
  if (turn !== undefined) {
    const by = thing.kind === "robot" ? Math.PI / 2 : event.shiftKey ? SMALL_TURN_RAD : TURN_RAD;
    return { change: { pose: { yaw: pose.yaw + turn * by } } };
  }
  if (event.key === "Delete") return { does: "remove" };
  if (event.key.toLowerCase() === "n") return { does: "add" };
  const go = GOES[event.key];
  return go === undefined ? null : { go };
}

/** Up is deeper, down less; right is wider, left less. */
function grown(thing: Thing, [deeper, left]: readonly [number, number], small: boolean): ThingChange {
  const by = small ? SMALL_STEP_M : GROWS_M;
  return resizedBy(thing, deeper * by, -left * by);
}

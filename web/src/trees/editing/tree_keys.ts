// What keys at a node of the drawing do.
import type { Direction } from "./moves";
import type { GoalKind } from "./plain_node";

export type Action =
  | { act: "move"; direction: Direction }
  | { act: "wrap"; kind: GoalKind }
  | { act: "remove" | "rename" | "duplicate" | "copy" | "cut" | "paste" | "leaf" };

const MOVES: Readonly<Record<string, Direction>> = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "out", ArrowRight: "in" };
const WRAPS: Readonly<Record<string, GoalKind>> = { t: "then", a: "and", o: "or" };
const WITH_CONTROL = { c: "copy", x: "cut", v: "paste", d: "duplicate" } as const;
const ALONE = { Delete: "remove", Backspace: "remove", F2: "rename", n: "leaf" } as const;

/** What a key means; null for what it does elsewhere. */
export function actionOf(event: Pick<KeyboardEvent, "key" | "altKey" | "ctrlKey" | "metaKey" | "shiftKey">): Action | null {
  const { key, altKey, shiftKey } = event;
  const control = event.ctrlKey || event.metaKey;
  if (shiftKey) return null;
  if (altKey) {
    const direction = control ? undefined : MOVES[key];
    return direction === undefined ? null : { act: "move", direction };
  }
  const low = key.toLowerCase();
  if (control) return low in WITH_CONTROL ? { act: WITH_CONTROL[low as keyof typeof WITH_CONTROL] } : null;
  const kind = WRAPS[low];
  if (kind !== undefined) return { act: "wrap", kind };
  const name = low === "n" ? low : key;
  return name in ALONE ? { act: ALONE[name as keyof typeof ALONE] } : null;
}

// Where a node goes that is moved with the keys or dropped at another one.
import { childrenOf, goalKindOf, nodeAt, pathOf, type PlainNode, stepsOf } from "./plain_node";
import type { TreeEdit } from "./tree_edit";

export type Direction = "up" | "down" | "out" | "in";

/** `before` and `after` a node, or `inside` a goal node, as its last child. */
export interface Drop {
  path: string;
  where: "before" | "after" | "inside";
}

type Move = Extract<TreeEdit, { do: "move" }>;

/** The move of a node in a direction; null where there is nothing to go to. */
export function movedTo(tree: PlainNode, path: string, direction: Direction): Move | null {
  const steps = stepsOf(path);
  const index = steps.pop();
  if (index === undefined) return null;
  const into = pathOf(steps);
  const siblings = childrenOf(nodeAt(tree, into) as PlainNode);
  const to = (place: string, at: number): Move => ({ do: "move", path, into: place, at });
  switch (direction) {
    case "up":
      return index === 0 ? null : to(into, index - 1);
    case "down":
      return index === siblings.length - 1 ? null : to(into, index + 1);
    case "out":
      return steps.length === 0 ? null : to(pathOf(steps.slice(0, -1)), (steps.at(-1) as number) + 1);
    case "in": {
      const before = siblings[index - 1];
      if (before !== undefined && goalKindOf(before) !== null) return to(pathOf([...steps, index - 1]), childrenOf(before).length);
      const after = siblings[index + 1];
      return after === undefined || goalKindOf(after) === null ? null : to(pathOf([...steps, index + 1]), 0);
    }
  }
}

/** Where something is put that comes to another node. */
export function placeAt(tree: PlainNode, { path, where }: Drop): { into: string; at: number } {
  if (where === "inside") return { into: path, at: childrenOf(nodeAt(tree, path) as PlainNode).length };
  const steps = stepsOf(path);
  const index = steps.pop() as number;
  return { into: pathOf(steps), at: where === "before" ? index : index + 1 };
}

/** The move of a node to where it is dropped; null where it stays. */
export function droppedAt(tree: PlainNode, path: string, drop: Drop): Move | null {
  if (path === "/" || `${drop.path}/`.startsWith(`${path}/`)) return null;
  const { into, at } = placeAt(tree, drop);
  const steps = stepsOf(path);
  const index = steps.pop() as number;
  const here = pathOf(steps) === into;
  const counted = here && at > index ? at - 1 : at;
  return here && counted === index ? null : { do: "move", path, into, at: counted };
}

// What can be changed of a task tree in its drawing, and what the tree is afterwards.
import { childrenOf, goalKindOf, type GoalKind, nodeAt, pathOf, type PlainNode, stepsOf } from "./plain_node";

export type TreeEdit =
  | { do: "insert"; into: string; at: number; node: PlainNode }
  | { do: "remove"; path: string }
  /** `at` counts the children once the node is out of them; `into` is a path as long as it is in. */
  | { do: "move"; path: string; into: string; at: number }
  | { do: "wrap"; path: string; kind: GoalKind }
  /** The children take their parent's place. */
  | { do: "dissolve"; path: string }
  | { do: "kind"; path: string; kind: GoalKind }
  /** All that a node says besides its children. */
  | { do: "fill"; path: string; values: PlainNode };

type Mutable = Record<string, unknown>;

/** The tree after an edit. */
export function applied(root: PlainNode, edit: TreeEdit): PlainNode {
  const tree = structuredClone(root) as Mutable;
  switch (edit.do) {
    case "insert":
      listAt(tree, edit.into).splice(edit.at, 0, structuredClone(edit.node) as Mutable);
      return tree;
    case "remove":
      taken(tree, edit.path);
      return tree;
    case "move": {
      const target = listAt(tree, edit.into);
      target.splice(edit.at, 0, taken(tree, edit.path));
      return tree;
    }
    case "wrap": {
      const wrapped = { [edit.kind]: [structuredClone(nodeAt(root, edit.path))] };
      return edit.path === "/" ? wrapped : withInstead(tree, edit.path, wrapped);
    }
    case "dissolve":
      return withInstead(tree, edit.path, ...(childrenOf(nodeAt(tree, edit.path) as PlainNode) as Mutable[]));
    case "kind":
    case "fill":
      return refilled(tree, edit);
  }
}

function refilled(tree: Mutable, edit: Extract<TreeEdit, { do: "kind" | "fill" }>): PlainNode {
  const node = nodeAt(tree, edit.path) as Mutable;
  const kind = goalKindOf(node);
  const children = kind === null ? {} : { [edit.do === "kind" ? edit.kind : kind]: node[kind] };
  const values = edit.do === "fill" ? edit.values : Object.fromEntries(Object.entries(node).filter(([key]) => key !== kind));
  for (const key of Object.keys(node)) delete node[key];
  Object.assign(node, structuredClone(values), children);
  return tree;
}

function withInstead(tree: Mutable, path: string, ...nodes: Mutable[]): PlainNode {
  const steps = stepsOf(path);
  const index = steps.pop() as number;
  listAt(tree, pathOf(steps)).splice(index, 1, ...nodes);
  return tree;
}

function taken(tree: Mutable, path: string): Mutable {
  const steps = stepsOf(path);
  const index = steps.pop() as number;
  return listAt(tree, pathOf(steps)).splice(index, 1)[0] as Mutable;
}

function listAt(tree: Mutable, path: string): Mutable[] {
  const node = nodeAt(tree, path) as Mutable;
  const kind = goalKindOf(node) as GoalKind;
  node[kind] ??= [];
  return node[kind] as Mutable[];
}

/** Where the node is, or the one next to it where it is gone, after an edit. */
export function selectedAfter(root: PlainNode, edit: TreeEdit): string {
  switch (edit.do) {
    case "insert":
      return pathOf([...stepsOf(edit.into), edit.at]);
    case "move":
      return pathOf([...stepsWithout(stepsOf(edit.into), stepsOf(edit.path)), edit.at]);
    case "remove": {
      const steps = stepsOf(edit.path);
      const index = steps.pop() as number;
      const left = childrenOf(nodeAt(root, pathOf(steps)) as PlainNode).length - 1;
      return left === 0 ? pathOf(steps) : pathOf([...steps, Math.min(index, left - 1)]);
    }
    default:
      return edit.path;
  }
}

/** The steps to a node once another one, which it is not under, is out of the tree. */
function stepsWithout(steps: readonly number[], gone: readonly number[]): number[] {
  const depth = gone.length - 1;
  const beside = steps.length > depth && gone.slice(0, depth).every((step, index) => step === steps[index]);
  const after = beside && (steps[depth] as number) > (gone[depth] as number);
  return steps.map((step, index) => (after && index === depth ? step - 1 : step));
}

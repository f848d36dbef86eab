// A node of a task tree as a task file has it, without its text.
import { isRecord } from "../../yaml_text/values";

export type GoalKind = "then" | "and" | "or";

export const GOAL_KINDS: readonly GoalKind[] = ["then", "and", "or"];

/** A goal node has its kind as a key, with its children; a leaf has `behavior`, and its parameters. */
export type PlainNode = Readonly<Record<string, unknown>>;

/** The kind of a goal node; null for a leaf, and for what is no node. */
export function goalKindOf(node: PlainNode): GoalKind | null {
  return GOAL_KINDS.find((kind) => kind in node) ?? null;
}

export function childrenOf(node: PlainNode): readonly PlainNode[] {
  const kind = goalKindOf(node);
  const children = kind === null ? null : node[kind];
  return Array.isArray(children) ? children.filter(isRecord) : [];
}

/** Whether a value is a node with nothing but nodes under it. */
export function isNode(value: unknown): value is PlainNode {
  if (!isRecord(value)) return false;
  const kinds = [...GOAL_KINDS, "behavior"].filter((kind) => kind in value);
  const kind = kinds[0];
  if (kind === undefined || kinds.length > 1) return false;
  if (kind === "behavior" || value[kind] === null) return true;
  return Array.isArray(value[kind]) && value[kind].every(isNode);
}

/** The indices on the way from the root to a node. */
export function stepsOf(path: string): number[] {
  return path.split("/").filter(Boolean).map(Number);
}

export function pathOf(steps: readonly number[]): string {
  return `/${steps.join("/")}`;
}

/** The node at a path; null where there is none. */
export function nodeAt(root: PlainNode, path: string): PlainNode | null {
  return stepsOf(path).reduce<PlainNode | null>((node, step) => (node === null ? null : (childrenOf(node)[step] ?? null)), root);
}

/** A node and all that are under it, each with its path, depth first. */
export function withPaths(node: PlainNode, path = "/"): [string, PlainNode][] {
  const under = childrenOf(node).flatMap((child, index) => withPaths(child, path === "/" ? `/${index}` : `${path}/${index}`));
  return [[path, node], ...under];
}

// The nodes of a task file's tree for the drawing, named as the service names them.
import type { TreeNode } from "../../tree/tree_node";
import { goalKindOf, type PlainNode, withPaths } from "./plain_node";

const NO_NAME = /[^A-Za-z0-9_-]/g;
const LONGEST_BASE = 57;

export function drawnNodes(tree: PlainNode): TreeNode[] {
  const nodes = withPaths(tree);
  const taken = new Set(nodes.flatMap(([, { name }]) => (typeof name === "string" ? [name] : [])));
  const counts = new Map<string, number>();
  return nodes.map(([path, node]) => {
    const { name, behavior } = node;
    return {
      path,
      kind: goalKindOf(node) ?? "behavior",
      name: typeof name === "string" ? name : madeName(node, taken, counts),
      behavior: goalKindOf(node) === null ? String(behavior ?? "") : null,
      state: null,
      level: null,
      potential: null,
      owner: null,
      byPerson: false,
      attempts: 0,
      steered: null,
    };
  });
}

/** What a node is called that has no name of its own: after its object, its behavior or its kind. */
function madeName(node: PlainNode, taken: Set<string>, counts: Map<string, number>): string {
  const kind = goalKindOf(node);
  const object = kind === null && typeof node.object === "string" ? node.object : "";
  const wanted = (object || kind || String(node.behavior ?? "")).replace(NO_NAME, "_");
  const base = (/^[A-Za-z]/.test(wanted) ? wanted : `x${wanted}`).slice(0, LONGEST_BASE);
  let name = base;
  while (taken.has(name)) {
    const count = (counts.get(base) ?? 1) + 1;
    counts.set(base, count);
    name = `${base}_${count}`;
  }
  taken.add(name);
  return name;
}

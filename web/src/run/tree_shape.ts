// What never changes of a run's task tree: kinds, parents, children and paths, a node being its index.
import { type DefinedNode, type NodeKind, pathsOf } from "../tree/tree_node";
import type { RunStarted } from "../wire/types";

export interface TreeShape {
  readonly definitions: readonly DefinedNode[];
  readonly kinds: readonly NodeKind[];
  /** -1 for the root. */
  readonly parents: readonly number[];
  readonly children: readonly (readonly number[])[];
  readonly paths: readonly string[];
  readonly indices: ReadonlyMap<string, number>;
}

/** The shape of the tree in its JSON form, as a run's first event has it. */
export function shapeOf(tree: RunStarted["tree"]): TreeShape {
  const definitions = tree.nodes as readonly DefinedNode[];
  const children: number[][] = definitions.map(() => []);
  for (const [index, { parent }] of definitions.entries()) {
    if (parent !== null) children[parent]?.push(index);
  }
  const paths = pathsOf(definitions.map((node) => node.parent));
  return {
    definitions,
    kinds: definitions.map((node) => node.kind),
    parents: definitions.map((node) => node.parent ?? -1),
    children,
    paths,
    indices: new Map(paths.map((path, index) => [path, index])),
  };
}

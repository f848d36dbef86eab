// Nodes that are put into a tree: a new leaf, a copy, what was cut out.
import { childrenOf, goalKindOf, type PlainNode, withPaths } from "./plain_node";

/** What the scene of a tree has; empty where it names none, or one that is not there. */
export interface SceneNames {
  objects: readonly string[];
  places: readonly string[];
}

/** What a leaf needs to be told; null where the behavior is not known. */
export type RequiredOf = (behavior: string) => readonly string[] | null;

const USUAL = "pick_and_place";

/** A leaf like those of the tree, for the first object and place that no leaf has yet. */
export function newLeaf(tree: PlainNode, beside: PlainNode | null, scene: SceneNames, required: RequiredOf): PlainNode {
  const leaves = withPaths(tree).map(([, node]) => node).filter((node) => goalKindOf(node) === null);
  const behavior = textOf(beside?.behavior) ?? textOf(leaves[0]?.behavior) ?? USUAL;
  const wanted = required(behavior) ?? [];
  const free = (names: readonly string[], key: string) => {
    const used = new Set(leaves.map((leaf) => leaf[key]));
    return names.filter((name) => !used.has(name));
  };
  const leaf: Record<string, unknown> = { behavior };
  const object = wanted.includes("object") ? free(scene.objects, "object")[0] : undefined;
  if (object !== undefined) leaf.object = object;
  const places = wanted.includes("place") ? free(scene.places, "place") : [];
  const place = places.find((name) => name === object) ?? places[0];
  if (place !== undefined) leaf.place = place;
  return leaf;
}

function textOf(value: unknown): string | null {
  return typeof value === "string" ? value : null;
}

/** A node as it can stand beside all others: names that are taken get a number. */
export function withFreeNames(node: PlainNode, tree: PlainNode): PlainNode {
  const taken = new Set(withPaths(tree).flatMap(([, { name }]) => (typeof name === "string" ? [name] : [])));
  return renamed(node, taken);
}

function renamed(node: PlainNode, taken: Set<string>): PlainNode {
  const kind = goalKindOf(node);
  const own = typeof node.name === "string" ? { name: freeNameLike(node.name, taken) } : {};
  const children = kind === null ? {} : { [kind]: childrenOf(node).map((child) => renamed(child, taken)) };
  return { ...node, ...own, ...children };
}

function freeNameLike(wanted: string, taken: Set<string>): string {
  const stem = wanted.replace(/_\d+$/, "");
  let name = wanted;
  for (let number = 2; taken.has(name); number++) name = `${stem}_${number}`;
  taken.add(name);
  return name;
}

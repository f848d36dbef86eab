// A task file's text in the nested form, with its tree.
import { isAlias, isMap, isSeq, type YAMLMap } from "yaml";
import type { Owner } from "../../yaml_text/items";
import { CannotEdit, endOf, pairOf, plainOf, readYaml, startOf, type YamlSource } from "../../yaml_text/source";
import { isRecord } from "../../yaml_text/values";
import { GOAL_KINDS, isNode, pathOf, type PlainNode, stepsOf, withPaths } from "./plain_node";
import { t } from "../../words/words";

/** Longer ones are drawn, but changed as text alone: each change reads all of it. */
export const LONGEST_TEXT = 256 * 1024;

export interface TaskSource extends YamlSource {
  tree: PlainNode;
  /** All besides the tree. */
  head: Readonly<Record<string, unknown>>;
}

/** An edit reads the text before and after it, which both are drawn, too. */
const MOST_KEPT = 3;
const kept = new Map<string, TaskSource | null>();

/** Read a text; null where it has no tree in the nested form that can be made out. */
export function readTask(text: string): TaskSource | null {
  if (text.length > LONGEST_TEXT) return null;
  let source = kept.get(text);
  if (source === undefined) source = readAnew(text);
  kept.delete(text);
  kept.set(text, source);
  for (const oldest of kept.keys()) if (kept.size > MOST_KEPT) kept.delete(oldest);
  return source;
}

function readAnew(text: string): TaskSource | null {
  const source = readYaml(text);
  if (source === null) return null;
  const { tree, ...head } = fieldsOf(source);
  return isNode(tree) ? { ...source, tree, head } : null;
}

function fieldsOf(source: YamlSource): Record<string, unknown> {
  try {
    const fields = plainOf(source, source.doc.contents);
    return isRecord(fields) ? fields : {};
  } catch (error) {
    // An alias of what stands nowhere before it.
    if (error instanceof ReferenceError) return {};
    throw error;
  }
}

/** The mapping of the node at a path. */
export function mapAt(source: TaskSource, path: string): YAMLMap {
  let found: unknown = source.doc.get("tree", true);
  for (const step of stepsOf(path)) found = childAt(found, step);
  if (isAlias(found)) throw new CannotEdit(t("This node stands in the text as an alias of another one: change it in the text."));
  if (!isMap(found)) throw new CannotEdit(t("This node cannot be found in the text."));
  return found;
}

function childAt(node: unknown, index: number): unknown {
  if (isAlias(node)) throw new CannotEdit(t("A node above this one is an alias in the text: change it in the text."));
  if (!isMap(node)) return null;
  const kind = GOAL_KINDS.find((each) => node.has(each));
  const children = kind === undefined ? null : node.get(kind, true);
  return isSeq(children) ? children.items[index] : null;
}

/** The list of children of the goal node at a path. */
export function childrenAt(source: TaskSource, path: string): Owner {
  const map = mapAt(source, path);
  const kind = GOAL_KINDS.find((each) => map.has(each));
  const pair = kind === undefined ? null : pairOf(map, kind);
  if (pair === null) throw new CannotEdit(t("Only a goal node has children."));
  return { map, pair };
}

/** The list that a node is in, and where in it. */
export function placeOf(source: TaskSource, path: string): { owner: Owner; index: number } {
  const steps = stepsOf(path);
  const index = steps.pop();
  if (index === undefined) throw new CannotEdit(t("The root cannot be moved or deleted: put another node above it first."));
  return { owner: childrenAt(source, pathOf(steps)), index };
}

/** The path of the innermost node that an offset is in; null outside of the tree. */
export function nodeAtOffset(source: TaskSource, offset: number): string | null {
  let found: string | null = null;
  for (const [path] of withPaths(source.tree)) {
    const map = mapAt(source, path);
    if (startOf(map) <= offset && offset <= endOf(source, map)) found = path;
  }
  return found;
}

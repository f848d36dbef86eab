// A task file's text after an edit of its tree: no other line changes, and no comment goes.
import { isMap, type YAMLMap } from "yaml";
import { itemInserted, itemLines, itemOf, itemRemoved, linesOf, listOf, commentsBelow } from "../../yaml_text/items";
import { pairRemoved, pairSet } from "../../yaml_text/pairs";
import { CannotEdit, endOf, isJson, keyEnd, lostComments, pairOf, startOf } from "../../yaml_text/source";
import { columnOf, lineEnd, lineStart, shifted, type Splice, spliced } from "../../yaml_text/splice";
import { sameValue } from "../../yaml_text/values";
import { childrenOf, goalKindOf, type GoalKind, nodeAt, pathOf, type PlainNode, stepsOf } from "./plain_node";
import { childrenAt, mapAt, placeOf, readTask, type TaskSource } from "./task_source";
import { applied, selectedAfter, type TreeEdit } from "./tree_edit";
import { t } from "../../words/words";

export interface Edited {
  text: string;
  /** The node that was changed, or the one next to it. */
  selected: string;
}

/** Do an edit. Raises `CannotEdit` where the text cannot say it. */
export function edited(text: string, edit: TreeEdit): Edited {
  const source = readTask(text);
  if (source === null) throw new CannotEdit(t("The text has no tree that can be changed in the drawing."));
  const selected = selectedAfter(source.tree, edit);
  if (edit.do !== "dissolve") return { text: editedAtOnce(source, edit), selected };
  return { text: dissolving(source, edit.path).reduce((before, step) => edited(before, step).text, text), selected };
}

/** The edits one after the other by which children take their parent's place. */
function dissolving({ tree }: TaskSource, path: string): TreeEdit[] {
  const steps = stepsOf(path);
  const index = steps.pop();
  if (index === undefined) throw new CannotEdit(t("The root cannot be dissolved."));
  const into = pathOf(steps);
  const count = childrenOf(nodeAt(tree, path) as PlainNode).length;
  const out = Array.from({ length: count }, (_, done): TreeEdit => {
    return { do: "move", path: pathOf([...steps, index, count - 1 - done]), into, at: index + 1 };
  });
  return [...out, { do: "remove", path }];
}

type EditAtOnce = Exclude<TreeEdit, { do: "dissolve" }>;

function editedAtOnce(source: TaskSource, edit: EditAtOnce): string {
  const after = edit.do === "fill" ? filled(source, edit.path, edit.values) : spliced(source.text, splicesOf(source, edit));
  const read = readTask(after);
  const lost = edit.do === "remove" ? [] : lostComments(source.text, after);
  const right = read !== null && sameValue(read.tree, applied(source.tree, edit)) && sameValue(read.head, source.head);
  if (!right || lost.length > 0) {
    throw new CannotEdit(t("This cannot be said in the text as it is written here: change it in the text."));
  }
  return after;
}

function splicesOf(source: TaskSource, edit: Exclude<EditAtOnce, { do: "fill" }>): Splice[] {
  switch (edit.do) {
    case "insert":
      return [itemInserted(source, childrenAt(source, edit.into), edit.at, { value: edit.node })];
    case "remove": {
      const { owner, index } = placeOf(source, edit.path);
      return itemRemoved(source, owner, index);
    }
    case "move":
      return moved(source, edit);
    case "wrap":
      return edit.path === "/" ? rootWrapped(source, edit.kind) : wrapped(source, edit.path, edit.kind);
    case "kind": {
      const { pair } = childrenAt(source, edit.path);
      const from = startOf(pair.key);
      const quote = /^["']/.exec(source.text.slice(from))?.[0] ?? "";
      return [{ from, to: endOf(source, pair.key), insert: quote + edit.kind + quote }];
    }
  }
}

function moved(source: TaskSource, { path, into, at }: Extract<TreeEdit, { do: "move" }>): Splice[] {
  const { owner, index } = placeOf(source, path);
  const target = childrenAt(source, into);
  if (`${into}/`.startsWith(`${path}/`)) throw new CannotEdit(t("A node cannot be moved into itself."));
  const same = target.pair === owner.pair;
  if (same && at === index) return [];
  const inserted = itemInserted(source, target, same && at >= index ? at + 1 : at, itemOf(source, owner, index));
  return [...itemRemoved(source, owner, index), inserted];
}

function wrapped(source: TaskSource, path: string, kind: GoalKind): Splice[] {
  const { owner, index } = placeOf(source, path);
  const map = mapAt(source, path);
  const list = listOf(owner);
  if (list.flow === true) return inBraces(source, map, kind);
  const { from, to, column } = itemLines(source, list, index);
  return [{ from, to, insert: `${" ".repeat(column)}- ${kind}:\n${shifted(source.text.slice(from, to), 4)}` }];
}

function inBraces(source: TaskSource, map: YAMLMap, kind: GoalKind): Splice[] {
  const [from, to] = [startOf(map), endOf(source, map)];
  const key = isJson(source, map) ? `"${kind}"` : kind;
  return [{ from, to, insert: `{${key}: [${source.text.slice(from, to)}]}` }];
}

function rootWrapped(source: TaskSource, kind: GoalKind): Splice[] {
  const { text, doc } = source;
  const map = mapAt(source, "/");
  const top = doc.contents;
  const pair = isMap(top) ? pairOf(top, "tree") : null;
  if (pair === null || !isMap(top) || top.flow === true) return inBraces(source, map, kind);
  const start = startOf(map);
  if (map.flow === true) {
    const end = endOf(source, map);
    const rest = text.slice(end, lineEnd(text, end));
    const column = columnOf(text, startOf(pair.key)) + 2;
    const pad = " ".repeat(column);
    const lines = shifted(linesOf({ flow: text.slice(start, end) }, column + 2), column + 2);
    return [{ from: keyEnd(pair), to: end + rest.length, insert: `${rest.trimEnd()}\n${pad}${kind}:\n${lines}` }];
  }
  const column = columnOf(text, start);
  const from = lineStart(text, start);
  const to = commentsBelow(text, lineEnd(text, endOf(source, map)), column - 1);
  const lines = shifted(text.slice(from, to), 4).slice(column + 4);
  return [{ from, to, insert: `${" ".repeat(column)}${kind}:\n${" ".repeat(column + 2)}- ${lines}` }];
}

/** The text once a node says other things besides its children. */
function filled(source: TaskSource, path: string, values: PlainNode): string {
  const node = nodeAt(source.tree, path) as PlainNode;
  const kind = goalKindOf(node);
  const gone = Object.keys(node).filter((key) => key !== kind && !(key in values));
  let text = source.text;
  const change = (of: (now: TaskSource) => Splice[]) => {
    const now = readTask(text);
    if (now === null) throw new CannotEdit(t("This cannot be said in the text: change it there."));
    text = spliced(text, of(now));
  };
  for (const [key, value] of Object.entries(values)) {
    if (!(key in node) || !sameValue(node[key], value)) {
      change((now) => pairSet(now, mapAt(now, path), key, value, key === "name"));
    }
  }
  for (const key of gone) change((now) => pairRemoved(now, mapAt(now, path), key));
  return text;
}

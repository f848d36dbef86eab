// What can be done to the selected node of a tree, each as one change of the text.
import { CannotEdit } from "../../yaml_text/source";
import { KIND_WORDS, plain } from "../../tree/words";
import { edited } from "./edited_text";
import { type Direction, type Drop, droppedAt, movedTo, placeAt } from "./moves";
import { newLeaf, type RequiredOf, type SceneNames, withFreeNames } from "./new_nodes";
import { goalKindOf, type GoalKind, nodeAt, pathOf, type PlainNode, stepsOf } from "./plain_node";
import type { TreeEdit } from "./tree_edit";
import { t } from "../../words/words";

/** What was copied or cut last, on this page. */
let copied: PlainNode | null = null;

export interface Work {
  text: string;
  tree: PlainNode;
  selected: string;
  scene: SceneNames;
  required: RequiredOf;
  /** What a node is called. */
  called: (path: string) => string;
  /** Take the text over, and go on at a node; `said` is what was done. */
  become: (text: string, selected: string, said: string) => void;
  refuse: (why: string) => void;
}

/** Do an edit, or say why it cannot be done. */
function doIt({ text, become, refuse }: Work, edit: TreeEdit, said: string): void {
  try {
    const after = edited(text, edit);
    become(after.text, after.selected, said);
  } catch (error) {
    if (!(error instanceof CannotEdit)) throw error;
    refuse(error.message);
  }
}

function selectedNode({ tree, selected }: Work): PlainNode {
  return nodeAt(tree, selected) as PlainNode;
}

const ALONE = t("Nothing can stand beside the root: wrap it first.");

/** `where` is undefined where there is no place for anything. */
export function add(work: Work, what: GoalKind | "leaf", where: Drop["where"] | undefined): void {
  if (where === undefined) return work.refuse(ALONE);
  const { tree, selected, scene, required } = work;
  const node = selectedNode(work);
  const leaf = newLeaf(tree, goalKindOf(node) === null ? node : null, scene, required);
  const added = what === "leaf" ? leaf : { [what]: [leaf] };
  const place = placeAt(tree, { path: selected, where });
  doIt(
    work,
    { do: "insert", ...place, node: added },
    t("{node} was added.", { node: what === "leaf" ? t("A leaf") : KIND_WORDS[what] }),
  );
}

/** Beside the selected node, or inside it where it is a goal node and `inside` is said. */
export function usualWhere(work: Pick<Work, "tree" | "selected">): readonly Drop["where"][] {
  const goal = goalKindOf(nodeAt(work.tree, work.selected) as PlainNode) !== null;
  if (work.selected === "/") return goal ? ["inside"] : [];
  return goal ? ["inside", "before", "after"] : ["after", "before"];
}

export function remove(work: Work): void {
  const said = t("{node} was deleted.", { node: plain(work.called(work.selected)) });
  doIt(work, { do: "remove", path: work.selected }, said);
}

export function wrap(work: Work, kind: GoalKind): void {
  doIt(
    work,
    { do: "wrap", path: work.selected, kind },
    t("{node} is in {kind} now.", { node: plain(work.called(work.selected)), kind: KIND_WORDS[kind] }),
  );
}

export function dissolve(work: Work): void {
  doIt(work, { do: "dissolve", path: work.selected }, t("The children are in its place now."));
}

export function changeKind(work: Work, kind: GoalKind): void {
  doIt(work, { do: "kind", path: work.selected, kind }, t("It is {kind} now.", { kind: KIND_WORDS[kind] }));
}

export function fill(work: Work, values: PlainNode): void {
  doIt(work, { do: "fill", path: work.selected, values }, "");
}

export function move(work: Work, direction: Direction): void {
  const edit = movedTo(work.tree, work.selected, direction);
  if (edit === null) work.refuse(NOWHERE[direction]);
  else doIt(work, edit, "");
}

const NOWHERE: Readonly<Record<Direction, string>> = {
  up: t("It is the first already."),
  down: t("It is the last already."),
  out: t("It is under the root already."),
  in: t("No goal node stands beside it to move it into."),
};

export function drop(work: Work, path: string, at: Drop): void {
  const edit = droppedAt(work.tree, path, at);
  if (edit !== null)
    doIt(work, edit, t("{node} is {where} now.", { node: plain(work.called(path)), where: placeSaid(work, at) }));
}

export function placeSaid({ called }: Pick<Work, "called">, { path, where }: Drop): string {
  return `${where} ${plain(called(path))}`;
}

export function duplicate(work: Work): void {
  insertAfter(work, selectedNode(work), t("It is there twice now."));
}

export function copy(work: Work): void {
  copied = selectedNode(work);
  work.refuse(t("{node} was copied.", { node: plain(work.called(work.selected)) }));
}

export function cut(work: Work): void {
  copied = selectedNode(work);
  remove(work);
}

/** After the selected node; inside a root. */
export function paste(work: Work): void {
  if (copied === null) work.refuse(t("Nothing was copied yet."));
  else insertAfter(work, copied, t("It was put in."));
}

function insertAfter(work: Work, node: PlainNode, said: string): void {
  const { tree, selected } = work;
  const steps = stepsOf(selected);
  const index = steps.pop();
  if (index === undefined && goalKindOf(tree) === null) return work.refuse(ALONE);
  const place = index === undefined ? placeAt(tree, { path: "/", where: "inside" }) : { into: pathOf(steps), at: index + 1 };
  doIt(work, { do: "insert", ...place, node: withFreeNames(node, tree) }, said);
}

// The drawing of a tree that can be changed: with its buttons, and a form for the selected node.
import { useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../../document/document_editor";
import type { EditedText } from "../../document/use_text";
import { TreeDrawing } from "../../tree/tree_drawing";
import { parentOf, type TreeNode } from "../../tree/tree_node";
import { startOf } from "../../yaml_text/source";
import { Dragging } from "./dragging";
import { type Drop, droppedAt, movedTo } from "./moves";
import { NodeForm } from "./node_form";
import { nodeProblems } from "./node_problems";
import { goalKindOf, nodeAt, type PlainNode } from "./plain_node";
import { mapAt, type TaskSource } from "./task_source";
import * as hands from "./tree_hands";
import { type Action, actionOf } from "./tree_keys";
import { TreeTools, type Where } from "./tree_tools";
import { useFocusKept } from "./use_focus_kept";
import { type TreeWork, useTreeWork } from "./use_tree_work";
import { t } from "../../words/words";

interface TreeEditingProps {
  editing: Editing;
  source: TaskSource;
  /** Whether the text has changed since. */
  stale: boolean;
  nodes: readonly TreeNode[];
  selected: string;
  onSelect: (path: string) => void;
}

export function TreeEditing({ editing, source, stale, nodes, selected: wanted, onSelect }: TreeEditingProps) {
  const { text, checked, toLine } = editing;
  const [where, setWhere] = useState<Where | null>(null);
  const form = useRef<HTMLDivElement>(null);
  const selected = stillThere(source.tree, wanted);
  const tree = useTreeWork({ source, stale, nodes, selected, onText: text.change, onSelect });
  const problems = useMemo(() => nodeProblems(source, checked), [source, checked]);
  const wheres = hands.usualWhere({ tree: source.tree, selected });
  const whereNow = where !== null && wheres.includes(where) ? where : wheres[0];
  const toName = () => form.current?.querySelector<HTMLInputElement>("#node-name")?.select();
  const toText = () => toLine(source.text.slice(0, startOf(mapAt(source, selected))).split("\n").length);
  const work = tree.work(false);
  return (
    <>
      <Tools text={text} work={work} wheres={wheres} where={whereNow} onWhere={setWhere} />
      <Drawing
        nodes={nodes}
        tree={tree}
        problems={problems}
        onSelect={onSelect}
        onAction={(action) => act(tree, action, whereNow, toName)}
      />
      <p class="edit-said small" role="status">
        {tree.said}
      </p>
      <div ref={form}>
        <NodeForm
          key={selected}
          node={nodeAt(source.tree, selected) as PlainNode}
          called={tree.called(selected)}
          problems={problems.get(selected) ?? []}
          behaviors={tree.behaviors}
          scene={tree.scene}
          onKind={(kind) => hands.changeKind(work, kind)}
          onFill={(values) => hands.fill(work, values)}
          onShow={toText}
        />
      </div>
    </>
  );
}

function act(tree: TreeWork, action: Action, where: Where | undefined, toName: () => void): void {
  const work = tree.work(true);
  switch (action.act) {
    case "move":
      return hands.move(work, action.direction);
    case "wrap":
      return hands.wrap(work, action.kind);
    case "leaf":
      return hands.add(work, "leaf", where);
    case "rename":
      return toName();
    default:
      return hands[action.act](work);
  }
}

interface ToolsProps {
  text: EditedText;
  work: hands.Work;
  wheres: readonly Where[];
  where: Where | undefined;
  onWhere: (where: Where) => void;
}

function Tools({ text, work, wheres, where, onWhere }: ToolsProps) {
  const { tree, selected } = work;
  return (
    <TreeTools
      canUndo={text.canUndo}
      canRedo={text.canRedo}
      wheres={wheres}
      where={where ?? "after"}
      isRoot={selected === "/"}
      isGoal={goalKindOf(nodeAt(tree, selected) as PlainNode) !== null}
      canMove={(direction) => movedTo(tree, selected, direction) !== null}
      onUndo={text.undo}
      onRedo={text.redo}
      onWhere={onWhere}
      onAdd={(what) => hands.add(work, what, where)}
      onWrap={(kind) => hands.wrap(work, kind)}
      onDissolve={() => hands.dissolve(work)}
      onDuplicate={() => hands.duplicate(work)}
      onRemove={() => hands.remove(work)}
      onMove={(direction) => hands.move(work, direction)}
    />
  );
}

interface DrawingProps {
  nodes: readonly TreeNode[];
  tree: TreeWork;
  problems: ReadonlyMap<string, readonly string[]>;
  onSelect: (path: string) => void;
  onAction: (action: Action) => void;
}

function Drawing({ nodes, tree, problems, onSelect, onAction }: DrawingProps) {
  const work = tree.work(true);
  const drawing = useFocusKept(nodes, () => tree.toDrawing(work.selected));
  const first = useMemo(() => new Map([...problems].map(([path, [problem]]) => [path, problem as string])), [problems]);
  const onKey = (event: KeyboardEvent) => {
    const action = actionOf(event);
    if (action === null) return;
    event.preventDefault();
    onAction(action);
  };
  const over = (path: string, drop: Drop | null) => {
    tree.say(
      drop === null
        ? t("{path} stays where it is.", { path: tree.called(path) })
        : `${tree.called(path)}: ${hands.placeSaid(work, drop)}`,
    );
  };
  return (
    <div ref={drawing}>
      <TreeDrawing
        nodes={nodes}
        label={t("Drawing of this text")}
        selected={work.selected}
        focus={work.selected}
        onSelect={onSelect}
        selectsOnFocus
        goTo={tree.goTo}
        problems={first}
        onKey={onKey}
        over={(layout) => (
          <Dragging
            layout={layout}
            allowed={(path, drop) => droppedAt(work.tree, path, drop) !== null}
            onOver={over}
            onDrop={(path, drop) => hands.drop(work, path, drop)}
          />
        )}
      />
    </div>
  );
}

/** The node at a path, or the nearest above where there is none any more. */
function stillThere(tree: PlainNode, path: string): string {
  let there = path;
  while (nodeAt(tree, there) === null) there = parentOf(there) ?? "/";
  return there;
}

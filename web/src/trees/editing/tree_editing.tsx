// The drawing of a tree that can be changed: with its buttons, and a form for the selected node.
import { useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../../document/document_editor";
import { TreeDrawing } from "../../tree/tree_drawing";
import { parentOf, type TreeNode } from "../../tree/tree_node";
import type { GoTo } from "../../tree/walk";
import { startOf } from "../../yaml_text/source";
import { Dragging } from "./dragging";
import { useBehaviors, useSceneNames } from "./known_names";
import { type Drop, droppedAt, movedTo } from "./moves";
import { NodeForm } from "./node_form";
import { nodeProblems } from "./node_problems";
import { parametersOf } from "./parameters";
import { goalKindOf, nodeAt, type PlainNode } from "./plain_node";
import { mapAt, type TaskSource } from "./task_source";
import * as hands from "./tree_hands";
import { type Action, actionOf } from "./tree_keys";
import { TreeTools, type Where } from "./tree_tools";

interface TreeEditingProps {
  editing: Editing;
  source: TaskSource;
  nodes: readonly TreeNode[];
  selected: string;
  onSelect: (path: string) => void;
}

export function TreeEditing({ editing, source, nodes, selected: wanted, onSelect }: TreeEditingProps) {
  const { text, checked, toLine } = editing;
  const [goTo, setGoTo] = useState<GoTo | null>(null);
  const [said, setSaid] = useState("");
  const [where, setWhere] = useState<Where | null>(null);
  const form = useRef<HTMLDivElement>(null);
  const behaviors = useBehaviors();
  const scene = useSceneNames(source.head.scene);
  const problems = useMemo(() => nodeProblems(source, checked), [source, checked]);
  const selected = stillThere(source.tree, wanted);
  const node = nodeAt(source.tree, selected) as PlainNode;
  const names = useMemo(() => new Map(nodes.map(({ path, name }) => [path, name])), [nodes]);
  const called = (path: string) => names.get(path) ?? path;
  const workFrom = (fromDrawing: boolean): hands.Work => ({
    text: text.text,
    tree: source.tree,
    selected,
    scene,
    called,
    required: (behavior) => requiredBy(behaviors?.find(({ name }) => name === behavior)?.parameters),
    become: (next, path, told) => {
      text.change(next);
      onSelect(path);
      if (fromDrawing) setGoTo({ path });
      setSaid(told);
    },
    refuse: setSaid,
  });
  const work = workFrom(false);
  const wheres = hands.usualWhere(work);
  const whereNow = where !== null && wheres.includes(where) ? where : wheres[0];
  const act = (action: Action) => {
    const doing = workFrom(true);
    switch (action.act) {
      case "move":
        return hands.move(doing, action.direction);
      case "wrap":
        return hands.wrap(doing, action.kind);
      case "leaf":
        return whereNow === undefined ? setSaid(ALONE) : hands.add(doing, "leaf", whereNow);
      case "rename":
        return form.current?.querySelector<HTMLInputElement>("#node-name")?.select();
      default:
        return hands[action.act](doing);
    }
  };
  const onKey = (event: KeyboardEvent) => {
    const action = actionOf(event);
    if (action === null) return;
    event.preventDefault();
    act(action);
  };
  const over = (path: string, drop: Drop | null) => setSaid(drop === null ? `${called(path)} stays where it is.` : `${called(path)}: ${hands.placeSaid(work, drop)}`);
  const toText = () => toLine(source.text.slice(0, startOf(mapAt(source, selected))).split("\n").length);
  const first = useMemo(() => new Map([...problems].map(([path, [problem]]) => [path, problem as string])), [problems]);
  return (
    <>
      <TreeTools
        canUndo={text.canUndo}
        canRedo={text.canRedo}
        wheres={wheres}
        where={whereNow ?? "after"}
        isRoot={selected === "/"}
        isGoal={goalKindOf(node) !== null}
        canMove={(direction) => movedTo(source.tree, selected, direction) !== null}
        onUndo={text.undo}
        onRedo={text.redo}
        onWhere={setWhere}
        onAdd={(what) => (whereNow === undefined ? setSaid(ALONE) : hands.add(work, what, whereNow))}
        onWrap={(kind) => hands.wrap(work, kind)}
        onDissolve={() => hands.dissolve(work)}
        onDuplicate={() => hands.duplicate(work)}
        onRemove={() => hands.remove(work)}
        onMove={(direction) => hands.move(work, direction)}
      />
      <TreeDrawing
        nodes={nodes}
        label="Drawing of this text"
        selected={selected}
        focus={selected}
        onSelect={onSelect}
        selectsOnFocus
        goTo={goTo}
        problems={first}
        onKey={onKey}
        over={(layout) => (
          <Dragging
            layout={layout}
            allowed={(path, drop) => droppedAt(source.tree, path, drop) !== null}
            onOver={over}
            onDrop={(path, drop) => hands.drop(workFrom(true), path, drop)}
          />
        )}
      />
      <p class="edit-said small" role="status">
        {said}
      </p>
      <div ref={form}>
        <NodeForm
          key={selected}
          node={node}
          called={called(selected)}
          problems={problems.get(selected) ?? []}
          behaviors={behaviors}
          scene={scene}
          onKind={(kind) => hands.changeKind(work, kind)}
          onFill={(values) => hands.fill(work, values)}
          onShow={toText}
        />
      </div>
    </>
  );
}

const ALONE = "Nothing can stand beside the root: wrap it first.";

/** The node at a path, or the nearest above where there is none any more. */
function stillThere(tree: PlainNode, path: string): string {
  let there = path;
  while (nodeAt(tree, there) === null) there = parentOf(there) ?? "/";
  return there;
}

function requiredBy(schema: Readonly<Record<string, unknown>> | undefined): readonly string[] | null {
  return schema === undefined ? null : parametersOf(schema).flatMap(({ key, required }) => (required ? [key] : []));
}

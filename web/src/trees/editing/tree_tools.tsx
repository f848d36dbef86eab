// The buttons that change a task tree: whatever they do, dragging or keys do too.
import type { ComponentChildren } from "preact";
import { KIND_WORDS } from "../../tree/words";
import type { Direction, Drop } from "./moves";
import { GOAL_KINDS, type GoalKind } from "./plain_node";

export type Where = Drop["where"];

export interface TreeToolsProps {
  canUndo: boolean;
  canRedo: boolean;
  /** Where the selected node lets something be added, the usual first. */
  wheres: readonly Where[];
  where: Where;
  isRoot: boolean;
  isGoal: boolean;
  canMove: (direction: Direction) => boolean;
  onUndo: () => void;
  onRedo: () => void;
  onWhere: (where: Where) => void;
  onAdd: (what: GoalKind | "leaf") => void;
  onWrap: (kind: GoalKind) => void;
  onDissolve: () => void;
  onDuplicate: () => void;
  onRemove: () => void;
  onMove: (direction: Direction) => void;
}

const WHERES: Readonly<Record<Where, string>> = { inside: "inside it", before: "before it", after: "after it" };
const DIRECTIONS: readonly (readonly [Direction, string, string])[] = [
  ["up", "↑", "Move up"],
  ["down", "↓", "Move down"],
  ["out", "←", "Move out of its parent"],
  ["in", "→", "Move into the goal node beside it"],
];

export function TreeTools(props: TreeToolsProps) {
  const { wheres, where, isRoot, isGoal } = props;
  return (
    <div class="tree-tools" role="group" aria-label="Change the task tree">
      <Group label="Undo and redo">
        <Tool label="Undo" disabled={!props.canUndo} onPress={props.onUndo} />
        <Tool label="Redo" disabled={!props.canRedo} onPress={props.onRedo} />
      </Group>
      <Group label="Add">
        <span class="tool-word" aria-hidden="true">
          Add
        </span>
        <Tool label="Leaf" spoken="Add a leaf" onPress={() => props.onAdd("leaf")} />
        {GOAL_KINDS.map((kind) => (
          <Tool key={kind} label={KIND_WORDS[kind]} spoken={`Add ${KIND_WORDS[kind]}`} onPress={() => props.onAdd(kind)} />
        ))}
        {wheres.length > 1 && (
          <select class="tool" aria-label="Where to add" value={where} onChange={(event) => props.onWhere(event.currentTarget.value as Where)}>
            {wheres.map((each) => (
              <option key={each} value={each}>
                {WHERES[each]}
              </option>
            ))}
          </select>
        )}
      </Group>
      <Group label="Wrap">
        <span class="tool-word" aria-hidden="true">
          Wrap in
        </span>
        {GOAL_KINDS.map((kind) => (
          <Tool key={kind} label={KIND_WORDS[kind]} spoken={`Wrap in ${KIND_WORDS[kind]}`} onPress={() => props.onWrap(kind)} />
        ))}
        {isGoal && !isRoot && <Tool label="Unwrap" spoken="Unwrap: its children take its place" onPress={props.onDissolve} />}
      </Group>
      <Group label="Move">
        {DIRECTIONS.map(([direction, sign, spoken]) => (
          <Tool key={direction} label={sign} spoken={spoken} disabled={!props.canMove(direction)} onPress={() => props.onMove(direction)} />
        ))}
      </Group>
      <Group label="Copy and delete">
        <Tool label="Duplicate" disabled={isRoot} onPress={props.onDuplicate} />
        <Tool label="Delete" disabled={isRoot} onPress={props.onRemove} />
      </Group>
    </div>
  );
}

function Group({ label, children }: { label: string; children: ComponentChildren }) {
  return (
    <div class="tool-group" role="group" aria-label={label}>
      {children}
    </div>
  );
}

function Tool(props: { label: string; spoken?: string; disabled?: boolean; onPress: () => void }) {
  const { label, spoken, disabled = false, onPress } = props;
  return (
    <button type="button" class="tool" aria-label={spoken} title={spoken} disabled={disabled} onClick={onPress}>
      {label}
    </button>
  );
}

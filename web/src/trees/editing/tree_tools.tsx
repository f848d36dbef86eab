// The buttons that change a task tree: whatever they do, dragging or keys do too.
import type { ComponentChildren } from "preact";
import { KIND_WORDS } from "../../tree/words";
import type { Direction, Drop } from "./moves";
import { GOAL_KINDS, type GoalKind } from "./plain_node";
import { t } from "../../words/words";

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

const WHERES: Readonly<Record<Where, string>> = { inside: t("inside it"), before: t("before it"), after: t("after it") };
const DIRECTIONS: readonly (readonly [Direction, string, string])[] = [
  ["up", "↑", t("Move up")],
  ["down", "↓", t("Move down")],
  ["out", "←", t("Move out of its parent")],
  ["in", "→", t("Move into the goal node beside it")],
];

export function TreeTools(props: TreeToolsProps) {
  const { wheres, where, isRoot, isGoal } = props;
  return (
    <div class="tree-tools" role="group" aria-label={t("Change the task tree")}>
      <Group label={t("Undo and redo")}>
        <Tool label={t("Undo")} disabled={!props.canUndo} onPress={props.onUndo} />
        <Tool label={t("Redo")} disabled={!props.canRedo} onPress={props.onRedo} />
      </Group>
      <Group label={t("Add")}>
        <span class="tool-word" aria-hidden="true">{t("Add")}</span>
        <Tool label={t("Leaf")} spoken={t("Add a leaf")} onPress={() => props.onAdd("leaf")} />
        {GOAL_KINDS.map((kind) => (
          <Tool key={kind} label={KIND_WORDS[kind]} spoken={t("Add {kind}", { kind: KIND_WORDS[kind] })} onPress={() => props.onAdd(kind)} />
        ))}
        {wheres.length > 1 && (
          <select class="tool" aria-label={t("Where to add")} value={where} onChange={(event) => props.onWhere(event.currentTarget.value as Where)}>
            {wheres.map((each) => (
              <option key={each} value={each}>
                {WHERES[each]}
              </option>
            ))}
          </select>
        )}
      </Group>
      <Group label={t("Wrap")}>
        <span class="tool-word" aria-hidden="true">{t("Wrap in")}</span>
        {GOAL_KINDS.map((kind) => (
          <Tool key={kind} label={KIND_WORDS[kind]} spoken={t("Wrap in {kind}", { kind: KIND_WORDS[kind] })} onPress={() => props.onWrap(kind)} />
        ))}
        {isGoal && !isRoot && <Tool label={t("Unwrap")} spoken={t("Unwrap: its children take its place")} onPress={props.onDissolve} />}
      </Group>
      <Group label={t("Move")}>
        {DIRECTIONS.map(([direction, sign, spoken]) => (
          <Tool key={direction} label={sign} spoken={spoken} disabled={!props.canMove(direction)} onPress={() => props.onMove(direction)} />
        ))}
      </Group>
      <Group label={t("Copy and delete")}>
        <Tool label={t("Duplicate")} disabled={isRoot} onPress={props.onDuplicate} />
        <Tool label={t("Delete")} disabled={isRoot} onPress={props.onRemove} />
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

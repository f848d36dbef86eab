// The state of a run after some of its events: a pure fold, as the service's own.
import type {
  Answered,
  DialogueOpened,
  Event,
  HelpAwaited,
  IssueRaised,
  NodeStarted,
  NodeTaken,
  NodeView,
  Prompt,
  Resolved,
  RunResult,
  RunStarted,
  RunStatus,
} from "../wire/types";
import type { Told } from "../wire/told";
import { activationOf, type LeafStatus } from "./activation";
import { lastOf } from "./transcript_lines";
import { beginSteering, foldSteering, type Steering } from "./steering/steering_fold";
import { shapeOf, type TreeShape } from "./tree_shape";
import { t } from "../words/words";

export interface LeafState {
  readonly status: LeafStatus;
  readonly owner: string | null;
  /** Attempts that have failed. */
  readonly attempts: number;
}

/** What a robot is at. */
export interface Execution {
  readonly id: string;
  readonly node: string;
  readonly name: string;
  /** 0 before the first step. */
  readonly step: number;
  readonly stepName: string;
  readonly held: boolean;
}

/** An open dialogue. */
export interface OpenDialogue {
  readonly opened: DialogueOpened;
  readonly raised: IssueRaised | null;
  readonly prompt: Prompt | null;
  /** The question that waits for an answer. */
  readonly asked: Prompt | null;
  readonly helpAwaited: HelpAwaited | null;
  readonly answered: Answered | null;
  readonly claimedBy: string | null;
}

export interface RunState {
  readonly started: RunStarted;
  readonly shape: TreeShape;
  readonly seq: number;
  readonly time: number;
  readonly status: RunStatus;
  readonly result: RunResult | null;
  /** By node; goal nodes keep the idle one. */
  readonly leaves: readonly LeafState[];
  readonly abandoned: ReadonlySet<number>;
  /** Of each leaf, as at the last choice in which it was a candidate. */
  readonly potentials: ReadonlyMap<number, number>;
  readonly choice: NodeStarted | null;
  readonly executions: ReadonlyMap<string, Execution>;
  /** The leaves that people do themselves, by path. */
  readonly people: ReadonlyMap<string, NodeTaken>;
  readonly dialogues: ReadonlyMap<string, OpenDialogue>;
  readonly raised: IssueRaised | null;
  readonly resolutions: readonly Resolved[];
  readonly lost: ReadonlySet<string>;
  readonly steering: Steering;
}

const IDLE: LeafState = { status: "idle", owner: null, attempts: 0 };

/** The state right after a run's first event. */
export function begin(started: RunStarted): RunState {
  const shape = shapeOf(started.tree);
  return {
    started,
    shape,
    seq: started.seq,
    time: started.time,
    status: "running",
    result: null,
    leaves: shape.kinds.map(() => IDLE),
    abandoned: new Set(),
    potentials: new Map(),
    choice: null,
    executions: new Map(),
    people: new Map(),
    dialogues: new Map(),
    raised: null,
    resolutions: [],
    lost: new Set(),
    steering: beginSteering(started),
  };
}

/** The state after one more event; events come in order of `seq`. */
export function fold(state: RunState, event: Told): RunState {
  const seq = Math.max(state.seq, event.seq);
  const steering = foldSteering(state.steering, event);
  return { ...applied(state, event), steering, seq, time: Math.max(state.time, event.time) };
}

function applied(state: RunState, event: Told): RunState {
  switch (event.type) {
    case "node_started":
      return start(state, event);
    case "node_taken":
      return {
        ...withLeaf(state, event.node, (leaf) => ({ ...leaf, status: "active", owner: event.helper })),
        people: new Map(state.people).set(event.node, event),
      };
    case "step_started":
      return withExecution(state, event.robot, (execution) =>
        execution.id === event.execution
          ? { ...execution, step: event.step, stepName: event.step_name }
          : execution,
      );
    case "robot_holding":
      return withExecution(state, event.robot, (execution) => ({ ...execution, held: true }));
    case "robot_resumed":
      return withExecution(state, event.robot, (execution) => ({ ...execution, held: false }));
    case "issue_raised": {
      const raised = { ...state, raised: event };
      if (!event.interrupts) return raised;
      return withExecution(raised, event.robot, (execution) => ({ ...execution, held: true }));
    }
    case "node_done":
    case "node_left_out":
      return endWork(withLeaf(state, event.node, (leaf) => ({ ...leaf, status: "done", owner: null })), event.node);
    case "node_undone":
      return withLeaf(state, event.node, (leaf) => ({ ...leaf, status: "idle", owner: null }));
    case "node_reset": {
      const failed = event.failed_attempt ? 1 : 0;
      const put = (leaf: LeafState): LeafState => ({ status: "idle", owner: null, attempts: leaf.attempts + failed });
      return endWork(withLeaf(state, event.node, put), event.node);
    }
    case "node_abandoned":
      return { ...state, abandoned: new Set(state.abandoned).add(indexOf(state, event.node)) };
    case "leaf_tried_again":
      return tryAgain(state, event.node);
    case "run_paused":
      return { ...state, status: "paused" };
    case "run_resumed":
      return { ...state, status: "running" };
    case "run_finished":
      return end(state, "finished", {
        reason: lastOf(event),
        node: null,
        missing: event.missing,
        unseen: event.unseen,
      });
    case "run_failed":
      return end(state, "failed", { reason: event.reason, node: event.node, missing: [], unseen: [] });
    case "run_aborted":
      return end(state, "aborted", { reason: event.reason || t("aborted by a person"), node: null, missing: [], unseen: [] });
    case "robot_lost":
      return { ...state, lost: new Set(state.lost).add(event.robot) };
    case "robot_back":
      return { ...state, lost: new Set([...state.lost].filter((robot) => robot !== event.robot)) };
    default:
      return "dialogue" in event ? withDialogueEvent(state, event) : state;
  }
}

function indexOf(state: RunState, path: string): number {
  const index = state.shape.indices.get(path);
  if (index === undefined) throw new Error(`expected a node of the run's tree, got ${path}`);
  return index;
}

function start(state: RunState, event: NodeStarted): RunState {
  const potentials = new Map(state.potentials);
  for (const candidate of event.candidates) potentials.set(indexOf(state, candidate.node), candidate.potential);
  const { execution: id, node, name } = event;
  const execution: Execution = { id, node, name, step: 0, stepName: "", held: false };
  const started = withLeaf(state, node, (leaf) => ({ ...leaf, status: "active", owner: event.robot }));
  return {
    ...started,
    potentials,
    choice: event,
    executions: new Map(state.executions).set(event.robot, execution),
  };
}

/** As if it were new: neither done nor given up, without failed attempts. */
function tryAgain(state: RunState, path: string): RunState {
  const again = withLeaf(state, path, () => IDLE);
  const left = [...state.abandoned].filter((node) => !isAtOrUnder(path, state.shape.paths[node] as string));
  return left.length === state.abandoned.size ? again : { ...again, abandoned: new Set(left) };
}

function isAtOrUnder(path: string, top: string): boolean {
  return path === top || path.startsWith(top === "/" ? "/" : `${top}/`);
}

function withLeaf(state: RunState, path: string, change: (leaf: LeafState) => LeafState): RunState {
  const index = indexOf(state, path);
  return { ...state, leaves: state.leaves.with(index, change(state.leaves[index] as LeafState)) };
}

function withExecution(state: RunState, robot: string, change: (execution: Execution) => Execution): RunState {
  const execution = state.executions.get(robot);
  if (execution === undefined) return state;
  return { ...state, executions: new Map(state.executions).set(robot, change(execution)) };
}

/** Nobody is at a leaf any more, neither a robot nor a person. */
function endWork(state: RunState, path: string): RunState {
  const left = [...state.executions].filter(([, execution]) => execution.node !== path);
  const people = [...state.people].filter(([node]) => node !== path);
  return { ...state, executions: new Map(left), people: new Map(people) };
}

function end(state: RunState, status: RunStatus, result: RunResult): RunState {
  return { ...state, status, result };
}

type DialogueEvent = Extract<Event, { dialogue: string | null }>;

function withDialogueEvent(state: RunState, event: DialogueEvent): RunState {
  switch (event.type) {
    case "dialogue_opened": {
      const opened: OpenDialogue = {
        opened: event,
        raised: state.raised,
        prompt: null,
        asked: null,
        helpAwaited: null,
        answered: null,
        claimedBy: null,
      };
      return { ...state, dialogues: new Map(state.dialogues).set(event.dialogue, opened) };
    }
    case "prompt":
      return withDialogue(state, event.dialogue, (dialogue) =>
        event.kind === "ask"
          ? { ...dialogue, prompt: event, asked: event, helpAwaited: null }
          : { ...dialogue, prompt: event },
      );
    case "claimed":
      return withDialogue(state, event.dialogue, (dialogue) => ({ ...dialogue, claimedBy: event.helper }));
    case "released":
      return withDialogue(state, event.dialogue, (dialogue) => ({ ...dialogue, claimedBy: null }));
    case "answered":
      return withDialogue(state, event.dialogue, (dialogue) => ({
        ...dialogue,
        answered: event,
        asked: dialogue.asked?.prompt === event.prompt ? null : dialogue.asked,
        claimedBy: null,
      }));
    case "help_awaited":
      return withDialogue(state, event.dialogue, (dialogue) => ({ ...dialogue, helpAwaited: event }));
    case "help_verified":
    case "help_not_seen":
    case "promise_taken_back":
      return withDialogue(state, event.dialogue, (dialogue) => ({ ...dialogue, helpAwaited: null }));
    case "resolved":
      return { ...state, resolutions: [...state.resolutions, event] };
    case "dialogue_closed": {
      const dialogues = new Map(state.dialogues);
      dialogues.delete(event.dialogue);
      return { ...state, dialogues };
    }
    default:
      return state;
  }
}

function withDialogue(state: RunState, id: string, change: (dialogue: OpenDialogue) => OpenDialogue): RunState {
  const dialogue = state.dialogues.get(id);
  if (dialogue === undefined) return state;
  return { ...state, dialogues: new Map(state.dialogues).set(id, change(dialogue)) };
}

/** What an open dialogue waits for, if for anything. */
export function awaiting(dialogue: OpenDialogue): "answer" | "help" | null {
  if (dialogue.helpAwaited !== null) return "help";
  return dialogue.asked === null ? null : "answer";
}

/** Whether a run is over. */
export function ended(status: RunStatus): boolean {
  return status === "finished" || status === "failed" || status === "aborted";
}

/** Every node in the tree's order, as the service's view of a run has them. */
export function nodeViews(state: RunState): NodeView[] {
  const { shape, leaves } = state;
  const nodes = activationOf(shape, {
    running: state.status === "running",
    statusOf: (leaf) => (leaves[leaf] as LeafState).status,
    potentialOf: (leaf) => state.potentials.get(leaf) ?? 0,
    abandoned: state.abandoned,
  });
  return nodes.map((node, index) => {
    const definition = shape.definitions[index] as TreeShape["definitions"][number];
    const leaf = leaves[index] as LeafState;
    return {
      node: shape.paths[index] as string,
      name: definition.name,
      kind: definition.kind,
      behavior: definition.behavior ?? null,
      object: text(definition.parameters?.object),
      place: text(definition.parameters?.place),
      activation_level: node.level,
      activation_potential: node.potential,
      active: node.active,
      done: node.done,
      abandoned: node.abandoned,
      owner: leaf.owner,
      attempts: leaf.attempts,
    };
  });
}

function text(value: unknown): string | null {
  return typeof value === "string" ? value : null;
}

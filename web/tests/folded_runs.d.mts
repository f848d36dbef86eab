import type { Told } from "../src/wire/told";
import type { DialogueView, NodeView, RunResult, RunStatus, SteeringView } from "../src/wire/types";

/** What the service says of a run after one of its events. */
export interface Said {
  status: RunStatus;
  result: RunResult | null;
  nodes: NodeView[];
  dialogues: Pick<DialogueView, "dialogue" | "node" | "awaiting" | "claimed_by">[];
  steering: Omit<SteeringView, "run" | "seq">;
}

/** A run's events, and as many states. */
export interface FoldedRun {
  events: Told[];
  states: Said[];
}

export function foldedRuns(seeds: readonly string[]): FoldedRun[];

// The console's fold against the service's own, on runs that are made here and now.
import { beforeAll, describe, expect, it } from "vitest";
import { awaiting, nodeViews, type RunState } from "../src/run/fold";
import { createHistory } from "../src/run/history";
import { hasItsTurn, waitsOf } from "../src/run/steering/waits";
import type { Told } from "../src/wire/told";
import { type FoldedRun, foldedRuns, type Said } from "./folded_runs.mjs";

// Two in which everything changes that can.
const SEEDS = ["12", "23"];

let runs: FoldedRun[] = [];

beforeAll(() => {
  runs = foldedRuns(SEEDS);
}, 600_000);

function said(state: RunState): Said {
  return {
    status: state.status,
    result: state.result,
    nodes: nodeViews(state),
    dialogues: [...state.dialogues.values()].map((dialogue) => ({
      dialogue: dialogue.opened.dialogue,
      node: dialogue.opened.node,
      awaiting: awaiting(dialogue),
      claimed_by: dialogue.claimedBy,
    })),
    steering: steered(state),
  };
}

/** As the service's view of a run's steering has it. */
function steered(state: RunState): Said["steering"] {
  const { autonomy, breakpoints, preferred } = state.steering;
  const views = new Map(nodeViews({ ...state, status: "running" }).map((view) => [view.node, view]));
  const told = ({ node, name, by, reason }: { node: string; name: string; by: string; reason: string }) => ({ node, name, by, reason });
  const turn = preferred === null ? undefined : views.get(preferred.node);
  return {
    autonomy,
    breakpoints: [...breakpoints.values()].map(told).toSorted((one, other) => (orderOf(state, one.node) - orderOf(state, other.node))),
    preferred: preferred !== null && turn !== undefined && hasItsTurn(turn) ? told(preferred) : null,
    waits: waitsOf(state).map(({ node, name, breakpoint, by, reason, level }) => ({ node, name, breakpoint, by, reason, level })),
  };
}

function orderOf({ shape }: RunState, node: string): number {
  return shape.indices.get(node) ?? -1;
}

/** Of a finished run the console says what its transcript does. */
function asTold(said: Said): Said {
  if (said.result === null || said.status !== "finished") return said;
  const reason = `the run has finished: ${said.result.reason}`.replaceAll("_", " ");
  return { ...said, result: { ...said.result, reason } };
}

describe("fold", () => {
  it("says the same as the service after every event of every run", () => {
    expect(runs).toHaveLength(SEEDS.length + 2);
    for (const { events, states } of runs) {
      const history = createHistory();
      history.add(events);
      for (const [index, expected] of states.entries()) {
        expect(said(history.stateAfter(index + 1) as RunState)).toEqual(asTold(expected));
      }
    }
  });

  it("meets every kind of change in these runs", () => {
    const types = new Set(runs.flatMap(({ events }) => events.map((event) => event.type)));
    for (const type of [
      "node_reset",
      "node_abandoned",
      "node_undone",
      "run_paused",
      "run_failed",
      "run_finished",
      "help_verified",
      "help_not_seen",
      "breakpoint_set",
      "breakpoint_removed",
      "autonomy_set",
      "leaf_held",
      "leaf_let_go",
      "leaf_preferred",
      "leaf_not_preferred",
      "leaf_tried_again",
      "node_left_out",
      "node_taken",
    ]) {
      expect(types).toContain(type);
    }
  });
});

describe("history", () => {
  it("gives the same state whatever was looked at before", () => {
    for (const { events } of runs) {
      const [one, other] = [createHistory(), createHistory()];
      one.add(events);
      other.add(events);
      const counts = events.map((_, index) => index + 1);
      const inOrder = counts.map((count) => one.stateAfter(count));
      const backwards = counts.toReversed().map((count) => other.stateAfter(count));
      expect(backwards.toReversed()).toEqual(inOrder);
    }
  });

  it("takes each event once, however often it comes", () => {
    const { events } = runs[0] as FoldedRun;
    const history = createHistory();
    expect(history.add(events.slice(0, 10))).toBe(true);
    expect(history.add(events.slice(5, 10))).toBe(false);
    history.add(events.slice(5));
    expect(history.events).toEqual(events);
  });

  it("counts the events up to a time, or up to one of several at that time", () => {
    const { events } = runs[0] as FoldedRun;
    const history = createHistory();
    history.add(events);
    const dropped = events.findIndex((event) => event.type === "issue_raised");
    const { time, seq } = events[dropped] as Told;
    expect(history.countAt(time)).toBeGreaterThan(dropped + 1);
    expect(history.countAt(time, seq)).toBe(dropped + 1);
    expect(history.countAt(-1)).toBe(0);
  });
});

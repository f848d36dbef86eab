// What the console says of leaves that people do, and which of them it offers.
import { describe, expect, it } from "vitest";
import { begin, fold, nodeViews } from "../src/run/fold";
import { beingDone, canBeTaken, doersOf } from "../src/run/leaf_words";
import { sentence } from "../src/run/run_words";
import { nodesOfRun } from "../src/tree/tree_node";
import { described } from "../src/tree/words";
import type { Told } from "../src/wire/told";
import type { NodeTaken, NodeView, RunStarted } from "../src/wire/types";

const LEAF = { kind: "behavior", behavior: "pick_and_place", parent: 0 } as const;
const STARTED = {
  type: "run_started",
  options: {},
  seq: 1,
  time: 0,
  robots: ["pr2-1"],
  tree: {
    nodes: [
      { kind: "and", parent: null, name: "both" },
      { ...LEAF, name: "red_box", parameters: { object: "red_box", place: "red_box" } },
      { ...LEAF, name: "blue_box", parameters: { object: "blue_box", place: "blue_box" } },
    ],
  },
} as unknown as RunStarted;
const TAKEN = { type: "node_taken", seq: 2, time: 1, node: "/1", name: "blue_box", helper: "anna", until: 121, lines: [] } as unknown as NodeTaken & Told;
const DONE = { type: "node_done", seq: 3, time: 9, node: "/1", name: "blue_box", robot: "pr2-1", by: "human", lines: [] } as unknown as Told;

describe("a leaf that a person does", () => {
  const taken = fold(begin(STARTED), TAKEN);

  it("is theirs, and not done, until it is seen", () => {
    const [, , blue] = nodeViews(taken) as [NodeView, NodeView, NodeView];
    expect(blue).toMatchObject({ active: true, done: false, owner: "anna" });
    expect([...doersOf(taken)]).toEqual([["blue_box", "anna"]]);
    const seen = fold(taken, DONE);
    expect(seen.people.size).toBe(0);
    expect(nodeViews(seen)[2]).toMatchObject({ active: false, done: true, owner: null });
  });

  it("can be taken only where nobody is at it", () => {
    expect(nodeViews(begin(STARTED)).map(canBeTaken)).toEqual([false, true, true]);
    expect(nodeViews(taken).map(canBeTaken)).toEqual([false, true, false]);
  });

  it("is told as being done by them", () => {
    const drawn = nodesOfRun(nodeViews(taken), new Set(), taken.people)[2];
    expect(drawn && described(drawn, 0, 0)).toContain("being done by anna");
    expect(beingDone(TAKEN, "anna")).toMatch(/^You are doing blue box, until 2:01.0/);
    expect(beingDone(TAKEN, "bert")).toMatch(/^anna is doing blue box/);
  });
});

describe("a refusal", () => {
  it("is one sentence", () => {
    expect(sentence("it is done")).toBe("It is done.");
    expect(sentence("It is done!")).toBe("It is done!");
  });
});

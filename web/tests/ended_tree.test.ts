// The tree of a run that has ended: what failed is seen, and nothing waits any more.
import { describe, expect, it } from "vitest";
import { nodesOfRun } from "../src/tree/tree_node";
import type { NodeView } from "../src/wire/types";

function leaf(node: string, more: Partial<NodeView> = {}): NodeView {
  return {
    node, name: node, kind: "behavior", behavior: "pick_and_place", object: null, place: null, parameters: {},
    owner: null, active: false, done: false, abandoned: false, attempts: 0, activation_level: 1,
    activation_potential: 1, ...more,
  } as NodeView;
}

const VIEWS = [leaf("/0", { done: true }), leaf("/1"), leaf("/2"), leaf("/3", { abandoned: true })];

describe("the tree of a run that has ended", () => {
  it("shows which leaf could not be done, and which were left", () => {
    const states = nodesOfRun(VIEWS, new Set(), new Map(), { node: "/1" }).map(({ state }) => state);
    expect(states).toEqual(["done", "failed", "left", "abandoned"]);
  });

  it("calls no leaf failed that did not end the run", () => {
    const states = nodesOfRun(VIEWS, new Set(["/2"]), new Map(), { node: null }).map(({ state }) => state);
    expect(states).toEqual(["done", "left", "left", "abandoned"]);
  });

  it("waits while it goes on", () => {
    expect(nodesOfRun(VIEWS, new Set(["/2"])).map(({ state }) => state)).toEqual([
      "done", "eligible", "in_dialogue", "abandoned",
    ]);
  });
});

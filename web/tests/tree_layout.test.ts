import { describe, expect, it } from "vitest";
import { COMPACT, collapsedAtFirst, FULL, growTree, layoutTree, MOST_CHILDREN, type PlacedNode } from "../src/tree/layout";
import { nodesOfDefinition, parentOf, pathsAbove, type TreeNode } from "../src/tree/tree_node";

function wide(goals: number, leaves: number): TreeNode[] {
  const nodes: object[] = [{ kind: "and", parent: null, name: "root" }];
  for (let goal = 0; goal < goals; goal++) {
    const at = nodes.length;
    nodes.push({ kind: "then", parent: 0, name: `goal ${goal}` });
    for (let leaf = 0; leaf < leaves; leaf++) {
      nodes.push({ kind: "behavior", parent: at, name: `leaf ${goal} ${leaf}`, behavior: "pick_and_place" });
    }
  }
  return nodesOfDefinition({ nodes });
}

function overlap(a: PlacedNode, b: PlacedNode): boolean {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

describe("paths", () => {
  it("are those of child indices from the root", () => {
    expect(wide(2, 2).map((node) => node.path)).toEqual(["/", "/0", "/0/0", "/0/1", "/1", "/1/0", "/1/1"]);
  });

  it("know what is above them", () => {
    expect(parentOf("/")).toBeNull();
    expect(parentOf("/3")).toBe("/");
    expect(pathsAbove("/0/2/1")).toEqual(["/0/2", "/0", "/"]);
  });
});

describe("layout", () => {
  it.each([
    ["across", 1200],
    ["down", 344],
  ] as const)("goes %s at %i px, with no card over another", (direction, width) => {
    const layout = layoutTree(wide(4, 5), new Set(), width, FULL);
    expect(layout.direction).toBe(direction);
    for (const [i, a] of layout.nodes.entries()) {
      for (const b of layout.nodes.slice(i + 1)) expect(overlap(a, b)).toBe(false);
    }
  });

  it("fits a phone without being made smaller", () => {
    const layout = layoutTree(wide(3, 2), new Set(), 344, FULL);
    expect(layout.width).toBeLessThanOrEqual(344);
  });

  it("leaves out what is folded away, and says how much that is", () => {
    const layout = layoutTree(wide(2, 3), new Set(["/1"]), 1200, COMPACT);
    expect(layout.nodes.map((placed) => placed.node.path)).toEqual(["/", "/0", "/0/0", "/0/1", "/0/2", "/1"]);
    expect(layout.nodes.at(-1)?.hidden).toBe(3);
  });

  it("takes a tree that is a thousand nodes deep", () => {
    const nodes = Array.from({ length: 1000 }, (_, index) => ({
      kind: "then",
      parent: index === 0 ? null : index - 1,
      name: `deep ${index}`,
    }));
    expect(layoutTree(nodesOfDefinition({ nodes }), new Set(), 800, FULL).nodes).toHaveLength(1000);
  });
});

describe("folding away at first", () => {
  it("leaves a small tree open", () => {
    expect(collapsedAtFirst(wide(3, 3), 120, null)).toEqual(new Set());
  });

  it("shows about as many nodes of a large tree as asked for, and the way to the focus", () => {
    const nodes = wide(30, 30);
    const collapsed = collapsedAtFirst(nodes, 100, "/29/7");
    const shown = layoutTree(nodes, collapsed, 1200, FULL).nodes.map((placed) => placed.node.path);
    expect(shown.length).toBeLessThanOrEqual(100);
    expect(shown).toContain("/29/7");
  });
});

describe("a tree of 100,000 nodes", () => {
  const nodes = wide(2, 50_000);
  const focus = "/1/40000";
  const collapsed = collapsedAtFirst(nodes, 120, focus);
  const layout = layoutTree(nodes, collapsed, 1200, FULL, focus, growTree(nodes));

  it("has few of them placed, those around the one that matters among them", () => {
    expect(nodes).toHaveLength(100_003);
    const paths = layout.nodes.map((placed) => placed.node.path);
    expect(paths).toContain(focus);
    expect(paths.length).toBeLessThanOrEqual(MOST_CHILDREN + 3);
    expect(layout.nodes[0]?.leftOut).toBe(0);
    expect(layout.nodes.find((placed) => placed.node.path === "/1")).toMatchObject({
      hidden: 0,
      leftOut: 50_000 - MOST_CHILDREN,
    });
    expect(layout.nodes.find((placed) => placed.node.path === "/0")).toMatchObject({ hidden: 50_000, leftOut: 0 });
  });

  it("says where among all children those stand that are drawn", () => {
    const placed = layout.nodes.find((each) => each.node.path === focus);
    expect(placed).toMatchObject({ position: 40_001, siblings: 50_000 });
  });

  it("begins with the first children where none of them matters", () => {
    const first = layoutTree(nodes, new Set(["/1"]), 1200, FULL, null, growTree(nodes));
    expect(first.nodes[2]?.node.path).toBe("/0/0");
    expect(first.nodes).toHaveLength(MOST_CHILDREN + 3);
  });
});

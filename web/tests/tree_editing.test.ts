import { describe, expect, it } from "vitest";
import type { Checked } from "../src/document/checked";
import { FULL, layoutTree } from "../src/tree/layout";
import { drawnNodes } from "../src/trees/editing/drawn_nodes";
import { dropAt, markOf } from "../src/trees/editing/drop_position";
import { type Drop, droppedAt, movedTo } from "../src/trees/editing/moves";
import { newLeaf, withFreeNames } from "../src/trees/editing/new_nodes";
import { nodeProblems } from "../src/trees/editing/node_problems";
import { parametersOf, valueOf, type Parameter } from "../src/trees/editing/parameters";
import type { PlainNode } from "../src/trees/editing/plain_node";
import { readTask, type TaskSource } from "../src/trees/editing/task_source";
import { actionOf } from "../src/trees/editing/tree_keys";

const leaf = (object: string): PlainNode => ({ behavior: "pick_and_place", object, place: object });
const TREE: PlainNode = { then: [leaf("a"), { name: "bars", and: [leaf("b"), leaf("c")] }, leaf("d")] };

describe("a node that is moved", () => {
  it("by keys goes among its siblings, out of its parent, and into the goal node beside it", () => {
    expect(movedTo(TREE, "/0", "down")).toEqual({ do: "move", path: "/0", into: "/", at: 1 });
    expect(movedTo(TREE, "/0", "up")).toBeNull();
    expect(movedTo(TREE, "/1/0", "out")).toEqual({ do: "move", path: "/1/0", into: "/", at: 2 });
    expect(movedTo(TREE, "/0", "out")).toBeNull();
    expect(movedTo(TREE, "/0", "in")).toEqual({ do: "move", path: "/0", into: "/1", at: 0 });
    expect(movedTo(TREE, "/2", "in")).toEqual({ do: "move", path: "/2", into: "/1", at: 2 });
    expect(movedTo(TREE, "/1", "in")).toBeNull();
    expect(movedTo(TREE, "/", "down")).toBeNull();
  });

  it("by dropping goes where it is dropped, never into itself, and nowhere where it is", () => {
    expect(droppedAt(TREE, "/0", { path: "/2", where: "after" })).toEqual({ do: "move", path: "/0", into: "/", at: 2 });
    expect(droppedAt(TREE, "/2", { path: "/1", where: "inside" })).toEqual({ do: "move", path: "/2", into: "/1", at: 2 });
    expect(droppedAt(TREE, "/0", { path: "/1", where: "before" })).toBeNull();
    expect(droppedAt(TREE, "/1", { path: "/1/0", where: "after" })).toBeNull();
  });

  it("is dropped at the card that is nearest, at the edge of a goal node beside it", () => {
    const layout = layoutTree(drawnNodes(TREE), new Set(), 2000, FULL);
    const at = (path: string, share: number): Drop | null => {
      const { x, y, width, height } = layout.nodes.find(({ node }) => node.path === path) as (typeof layout.nodes)[0];
      return dropAt(layout, x + width / 2, y + share * height, "/0");
    };
    expect(at("/2", 0.3)).toEqual({ path: "/2", where: "before" });
    expect(at("/1/1", 0.9)).toEqual({ path: "/1/1", where: "after" });
    expect(at("/1", 0.1)).toEqual({ path: "/1", where: "before" });
    expect(at("/1", 0.5)).toEqual({ path: "/1", where: "inside" });
    expect(at("/", 0.1)).toEqual({ path: "/", where: "inside" });
    expect(dropAt(layout, 5000, 5000, "/0")).toBeNull();
    expect(markOf(layout, { path: "/1", where: "before" })?.height).toBe(4);
  });
});

describe("a new node", () => {
  const scene = { objects: ["a", "b", "e"], places: ["a", "e", "f"] };
  it("is a leaf for what no other leaf has yet, as far as its behavior needs that", () => {
    expect(newLeaf(TREE, null, scene, () => ["object", "place"])).toEqual(leaf("e"));
    expect(newLeaf(TREE, { behavior: "go_to" }, scene, () => ["place"])).toEqual({ behavior: "go_to", place: "e" });
    expect(newLeaf(TREE, null, { objects: [], places: [] }, () => null)).toEqual({ behavior: "pick_and_place" });
  });

  it("as a copy has names that are free", () => {
    const copy = withFreeNames({ name: "bars", and: [{ name: "bars_2", ...leaf("x") }] }, TREE);
    expect(copy).toEqual({ name: "bars_2", and: [{ name: "bars_3", ...leaf("x") }] });
  });

  it("is called as the service calls it", () => {
    const tree = { then: [leaf("cup"), { ...leaf("cup") }, { name: "cup_2", behavior: "go_to" }, { behavior: "go_to", place: "x" }, { and: [leaf("7up")] }] };
    expect(drawnNodes(tree).map(({ name }) => name)).toEqual(["then", "cup", "cup_3", "cup_2", "go_to", "and", "x7up"]);
  });
});

describe("keys at a node", () => {
  const pressed = (key: string, held: object = {}) => actionOf({ key, altKey: false, ctrlKey: false, metaKey: false, shiftKey: false, ...held });
  it("change the tree, and leave to the browser what means nothing here", () => {
    expect(pressed("Delete")).toEqual({ act: "remove" });
    expect(pressed("ArrowUp", { altKey: true })).toEqual({ act: "move", direction: "up" });
    expect(pressed("d", { ctrlKey: true })).toEqual({ act: "duplicate" });
    expect(pressed("O")).toEqual({ act: "wrap", kind: "or" });
    expect(pressed("ArrowUp")).toBeNull();
    expect(pressed("r", { ctrlKey: true })).toBeNull();
    expect(pressed("N")).toEqual({ act: "leaf" });
  });
});

describe("the parameters of a behavior", () => {
  it("are fields of the kinds that its schema says", () => {
    const schema = {
      required: ["place"],
      properties: {
        place: { $ref: "#/$defs/Name" },
        near_m: { anyOf: [{ type: "number", minimum: 0, maximum: 3 }, { type: "null" }] },
        needs_help: { type: "boolean" },
        side: { enum: ["left", "right"] },
        route: { type: "array" },
      },
      $defs: { Name: { type: "string" } },
    };
    const parameters = parametersOf(schema);
    expect(parameters.map(({ key, kind, required }) => [key, kind, required])).toEqual([
      ["place", "text", true],
      ["near_m", "number", false],
      ["needs_help", "truth", false],
      ["side", "choice", false],
      ["route", "other", false],
    ]);
    const [place, near, help, , route] = parameters as [Parameter, Parameter, Parameter, Parameter, Parameter];
    expect([valueOf(place, " a "), valueOf(near, "0.5"), valueOf(help, "false"), valueOf(route, "[1]")]).toEqual([" a ", 0.5, false, [1]]);
    expect(valueOf(near, "")).toBeUndefined();
    expect(() => valueOf(route, "[1")).toThrow(SyntaxError);
  });
});

it("mistakes are at their nodes, also those that have only a line, until these change", () => {
  const text = "name: t\ntree:\n  then:\n    - {behavior: a}\n    - and:\n        - {behavior: b}\n";
  const told = (errors: object[]): Checked => ({ check: { name: null, definition: null, errors, worlds: [] }, text }) as unknown as Checked;
  const now = (changed: string) => readTask(changed) as TaskSource;
  const errors = [
    { node: "/0", line: 4, message: "one" },
    { node: null, line: 6, message: "two" },
    { node: null, line: 1, message: "of the name" },
  ];
  expect([...nodeProblems(now(text), told(errors))]).toEqual([
    ["/0", ["one"]],
    ["/1/0", ["two"]],
  ]);
  expect([...nodeProblems(now(text.replace("behavior: a", "behavior: c")), told(errors)).keys()]).toEqual(["/1/0"]);
});

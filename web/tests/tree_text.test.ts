import { describe, expect, it } from "vitest";
import { freeName, nameIn, nameOfFile, NEW_TREE, renamed } from "../src/trees/tree_text";

describe("the name of a task file", () => {
  it.each([
    ["name: shelf\ntree: {}", "shelf"],
    ["# a comment\nname:   'shelf'   # so\n", "shelf"],
    ['name: "shelf-2"\r\ntree: x', "shelf-2"],
    ['{\n"name": "shelf",\n"tree": {}}', "shelf"],
    ["tree:\n  name: inner\n", null],
    ["name: 7up\n", null],
    ["name: two words\n", null],
    ["", null],
  ])("in %j is %j", (text, name) => {
    expect(nameIn(text)).toBe(name);
  });

  it("can be changed without touching anything else", () => {
    expect(renamed("scene: eket\nname: eket  # eket\ntree: eket\n", "other")).toBe(
      "scene: eket\nname: other  # eket\ntree: eket\n",
    );
    expect(renamed("tree: {}\n", "other")).toBe("tree: {}\n");
    expect(nameIn(renamed(NEW_TREE, "shelf"))).toBe("shelf");
  });

  it("of a copy is not taken, and no longer than a name may be", () => {
    expect(freeName("eket", new Set(["eket"]))).toBe("eket_copy");
    expect(freeName("eket", new Set(["eket_copy", "eket_copy_2"]))).toBe("eket_copy_3");
    expect(freeName("x".repeat(64), new Set()).length).toBeLessThanOrEqual(64);
  });

  it.each([
    ["shelf.yaml", "shelf"],
    ["my shelf (2).yml", "my_shelf_2_"],
    ["2026-shelf.json", "shelf"],
    ["规划.yaml", "my_tree"],
  ])("comes from a file called %j as %j", (file, name) => {
    expect(nameOfFile(file)).toBe(name);
  });
});

import { describe, expect, it } from "vitest";
import { type Ink, tint } from "../src/document/yaml_tint";

function inks(line: string): [Ink, string][] {
  return tint(line)
    .filter(({ text }) => text.trim() !== "")
    .map(({ ink, text }) => [ink, text.trim()]);
}

describe("the tint of a line", () => {
  it("tells keys, goals, values and comments apart", () => {
    expect(inks("name: shelf  # the small one")).toEqual([
      ["key", "name"],
      ["sign", ":"],
      ["plain", "shelf"],
      ["comment", "# the small one"],
    ]);
    expect(inks("  then:")[0]).toEqual(["goal", "then"]);
    expect(inks("x: -1.5, needs_help: true")).toContainEqual(["value", "true"]);
  });

  it("reads a leaf in braces", () => {
    expect(inks("- {behavior: pick_and_place, object: 'a, b'}")).toEqual([
      ["sign", "-"],
      ["sign", "{"],
      ["key", "behavior"],
      ["sign", ":"],
      ["plain", "pick_and_place"],
      ["sign", ","],
      ["key", "object"],
      ["sign", ":"],
      ["text", "'a, b'"],
      ["sign", "}"],
    ]);
  });

  it("takes no number or # out of the middle of a text", () => {
    expect(inks("description: Figure 1 of 2020, part#3")).not.toContainEqual(["value", "2020"]);
    expect(inks("description: part#3").map(([ink]) => ink)).not.toContain("comment");
  });

  it.each(["", "   ", "\t- {", "'", '"\\', "a: 'it''s", "{{{]]]::,,", "- - - 1", "é: 🙂 # ü", "key:value"])(
    "loses nothing of %j",
    (line) => {
      expect(
        tint(line)
          .map((piece) => piece.text)
          .join(""),
      ).toBe(line);
    },
  );

  it("is quick with a line that fits nothing", () => {
    const line = `${'"\\'.repeat(20_000)}${"a-".repeat(20_000)}`;
    expect(
      tint(line)
        .map((piece) => piece.text)
        .join(""),
    ).toBe(line);
  });
});

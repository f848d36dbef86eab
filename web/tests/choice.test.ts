import { describe, expect, it } from "vitest";
import { whyChosen } from "../src/run/choice";
import type { Candidate, NodeStarted } from "../src/wire/types";

function candidate(name: string, potential: number, attempts = 0): Candidate {
  return { node: `/${name}`, name, level: 1, potential, attempts, in_place: false, asked_for_by: null };
}

function choice(...candidates: [Candidate, ...Candidate[]]): NodeStarted {
  const { node, name } = candidates[0];
  const event = { seq: 2, time: 1, wall_time: "", run: "", node, name, robot: "pr2", boot: "", execution: "" };
  return { ...event, type: "node_started", attempt: 1, candidates };
}

describe("the reason of a choice", () => {
  it("is that there was no other", () => {
    expect(whyChosen(choice(candidate("pink_bar", 1)))).toBe("pink bar was the only one that could be started.");
  });

  it("is the highest potential among those that failed as rarely", () => {
    expect(whyChosen(choice(candidate("a", 1.4), candidate("b", 1.25)))).toBe(
      "a had the highest potential (1.40, the next 1.25).",
    );
    expect(whyChosen(choice(candidate("a", 1.4), candidate("b", 1.25), candidate("c", 9, 1)))).toContain(
      "leaving out c with more failed attempts",
    );
  });

  it("is fewer failed attempts, whatever the potentials", () => {
    expect(whyChosen(choice(candidate("a", 0.1), candidate("b", 2, 1)))).toBe("a had the fewest failed attempts (0).");
  });

  it("is that its part stands at its place already, whatever else differs", () => {
    const there = { ...candidate("tea", 0.1, 2), in_place: true };
    expect(whyChosen(choice(there, candidate("a", 1)))).toBe("What tea handles stands at its place already.");
  });

  it("is the place in the tree where nothing else differs", () => {
    expect(whyChosen(choice(candidate("a", 1), candidate("b", 1)))).toContain("comes first in the tree");
  });
});

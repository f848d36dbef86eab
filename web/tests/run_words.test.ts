import { describe, expect, it } from "vitest";
import { ago, clock, outcome } from "../src/run/run_words";
import type { RunResult, RunSummary } from "../src/wire/types";

const MINUTE = 60_000;

describe("how long ago a run began", () => {
  it.each([
    [0, "just now"],
    [-5000, "just now"],
    [59_000, "just now"],
    [MINUTE, "1 minute ago"],
    [59 * MINUTE, "59 minutes ago"],
    [60 * MINUTE, "1 hour ago"],
    [24 * 60 * MINUTE, "yesterday"],
    [72 * 60 * MINUTE, "3 days ago"],
  ])("%d ms is %j", (past, words) => {
    expect(ago(1e12 - past, 1e12)).toBe(words);
  });
});

describe("a time of a clock", () => {
  it.each([
    [7.44, "7.4 s"],
    [59.96, "1:00.0"],
    [127.4, "2:07.4"],
    [3600, "1:00:00.0"],
    [86_461, "24:01:01.0"],
  ])("%d s is %j", (time, words) => {
    expect(clock(time)).toBe(words);
  });
});

describe("what came of a run", () => {
  const run = (result: RunResult | null) => ({ result }) as RunSummary;

  it("is nothing while it goes on", () => {
    expect(outcome(run(null))).toBe("");
  });

  it("is its reason, as a sentence begins", () => {
    expect(outcome(run({ reason: "the task is done", node: null, missing: [], unseen: [] }))).toBe("The task is done");
  });
});

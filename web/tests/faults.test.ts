// Going from fault to fault of a run.
import { describe, expect, it } from "vitest";
import { faultBeside } from "../src/run/faults";
import type { Told } from "../src/wire/told";

const events = ["run_started", "issue_raised", "prompt", "robot_lost", "robot_back", "node_undone", "run_failed"].map(
  (type, index) => ({ type, seq: index + 1 }) as unknown as Told,
);
const beside = (seq: number, direction: -1 | 1) => faultBeside(events, seq, direction)?.seq ?? null;

describe("the fault beside a moment", () => {
  it("is the next one that went wrong after it", () => {
    expect([1, 2, 3, 4, 5, 6, 7].map((seq) => beside(seq, 1))).toEqual([2, 4, 4, 6, 6, null, null]);
  });

  it("is the last one that went wrong before it", () => {
    expect([1, 2, 3, 4, 5, 6, Infinity].map((seq) => beside(seq, -1))).toEqual([null, null, 2, 2, 4, 4, 6]);
  });
});

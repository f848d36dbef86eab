// Figures over many runs come with what they count, and are none where there is nothing to count.
import { describe, expect, it } from "vitest";
import { answersOf, lasted, outcomesOf, rateOf, runsOf } from "../src/statistics/statistics_words";
import type { OutcomeCounts, WorkStatistics } from "../src/wire/types";

const NONE: OutcomeCounts = { resolved: 0, withdrawn: 0, gave_up: 0, left_out: 0, aborted: 0, open: 0, unasked: 0 };
const work = (faults: number, picks: number): WorkStatistics => ({
  faults,
  picks,
  faults_per_1000_picks: picks === 0 ? null : (faults * 1000) / picks,
  outcomes: NONE,
  answers: { count: 0, median_s: null, p95_s: null },
});

describe("a rate", () => {
  it("says what it counts", () => {
    expect(rateOf(work(1, 3000))).toEqual({ value: "0.3", of: "1 fault in 3,000 picks" });
    expect(rateOf(work(12, 8))).toEqual({ value: "1,500.0", of: "12 faults in 8 picks" });
    expect(rateOf(work(0, 1))).toEqual({ value: "0.0", of: "0 faults in 1 pick" });
  });

  it("is none without picks", () => {
    expect(rateOf(work(3, 0))).toEqual({ value: "no picks", of: "3 faults" });
  });
});

describe("the time to answer", () => {
  it("says how many answers it is of", () => {
    expect(answersOf({ count: 20, median_s: 7.25, p95_s: 125 })).toEqual({
      value: "7.3 s",
      of: "95 % within 2 min 5 s, 20 answers",
    });
    expect(lasted(3900)).toBe("1 h 5 min");
    expect(lasted(59.97)).toBe("1 min 0 s");
  });

  it("is none without answers of people", () => {
    expect(answersOf(work(0, 0).answers).value).toBe("no answers");
  });
});

describe("outcomes and runs", () => {
  it("are those that there were", () => {
    expect(outcomesOf({ ...NONE, resolved: 1200, unasked: 1 })).toBe("1,200 resolved, 1 nobody was asked");
    expect(outcomesOf(NONE)).toBe("no faults");
    expect(runsOf({ total: 3, running: 1, paused: 0, finished: 2, failed: 0, aborted: 0 })).toEqual({
      value: "3",
      of: "1 running, 2 finished",
    });
    expect(runsOf({ total: 0, running: 0, paused: 0, finished: 0, failed: 0, aborted: 0 }).value).toBe("no runs");
  });
});

// The page where nothing is asked says what it sees, and calls nothing well that is not.
import { describe, expect, it } from "vitest";
import { glanceOf, type Seen } from "../src/question/glance";
import type { RobotView, RunStatus, RunSummary } from "../src/wire/types";

const NOW = Date.parse("2026-01-02T12:00:00Z");
const HOUR_MS = 3_600_000;

function run(id: string, status: RunStatus, hoursAgo = 1): RunSummary {
  const ended = status === "running" || status === "paused" ? null : new Date(NOW - hoursAgo * HOUR_MS).toISOString();
  return {
    id, status, ended, tree: "tea_table", world: "workcell", scenario: null, seed: 1, speed: 1, time: 3,
    started: new Date(NOW - 30 * HOUR_MS).toISOString(), robots: [], result: null, trouble: null, waits: [], live: true,
  };
}

function robot(state: RobotView["state"], of: string | null): RobotView {
  return { robot: "ada", state, run: of, connected: state !== "lost", simulated: false, behaviors: [], cameras: [], reach: null, model: null };
}

function glance(seen: Partial<Seen>) {
  return glanceOf({ connection: "connected", trouble: null, runs: [], robots: [], ofFleets: new Set(), known: [], now: NOW, ...seen });
}

describe("the page where nothing is asked", () => {
  it("is well only while something goes on", () => {
    expect(glance({}).sign).toBe("idle");
    expect(glance({}).more).toBe("No run goes on.");
    expect(glance({ runs: [run("a", "running")] })).toMatchObject({ sign: "well", more: "One run goes on." });
    const two = [run("a", "running"), run("b", "paused"), run("c", "finished")];
    expect(glance({ runs: two })).toMatchObject({ sign: "well", more: "2 runs go on, 1 of them paused." });
  });

  it("knows nothing without a connection, or before the runs were read", () => {
    for (const seen of [{ connection: "lost" }, { connection: "connecting" }, { runs: null }] as const) {
      expect(glance({ ...seen })).toMatchObject({ sign: "unknown", words: "Not known whether a robot asks anything." });
    }
  });

  it("tells of a run that has failed until somebody has looked at it", () => {
    const runs = [run("a", "running"), run("b", "failed"), run("c", "unreadable"), run("d", "aborted")];
    const told = glance({ runs });
    expect(told.sign).toBe("bad");
    expect(told.words).toBe("No robot asks anything, but not all is well.");
    expect(told.failures.map(({ id }) => id)).toEqual(["b", "c"]);
    expect(glance({ runs, known: ["b", "c"] }).sign).toBe("well");
  });

  it("leaves what robots of a fleet failed at to the fleet", () => {
    const runs = [{ ...run("b", "failed"), robots: ["r1"] }];
    expect(glance({ runs, ofFleets: new Set(["r1"]) }).sign).toBe("idle");
    expect(glance({ runs, ofFleets: new Set(["r2"]) }).sign).toBe("bad");
  });

  it("no longer tells of what failed more than a day ago", () => {
    expect(glance({ runs: [run("b", "failed", 25)] }).sign).toBe("idle");
    expect(glance({ runs: [run("b", "failed", 23)] }).sign).toBe("bad");
  });

  it("tells of a robot that is gone while its run waits for it", () => {
    const runs = [run("a", "running")];
    expect(glance({ runs, robots: [robot("lost", "a")] })).toMatchObject({ sign: "bad", lost: [{ robot: "ada" }] });
    expect(glance({ runs, robots: [robot("lost", null), robot("working", "a")] }).sign).toBe("well");
  });

  it("is not well while a run waits to be let go", () => {
    const wait = { node: "/0", name: "top", breakpoint: "/0", by: "ann", reason: "", level: "full" } as const;
    const told = glance({ runs: [{ ...run("a", "running"), waits: [wait] }] });
    expect(told).toMatchObject({ sign: "bad", words: "No robot asks anything, but one waits to be let go." });
    expect(glance({ runs: [{ ...run("a", "aborted"), waits: [wait] }] }).sign).toBe("idle");
  });

  it("is not well while the service cannot keep what happens", () => {
    expect(glance({ runs: [run("a", "running")], trouble: "the disk is full" }).sign).toBe("bad");
  });
});

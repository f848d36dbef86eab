// What the home page lists first, and whom it offers a demo.
import { describe, expect, it } from "vitest";
import { offersDemo } from "../src/home/demo";
import { robotsInOrder, standingOf } from "../src/home/robot_standing";
import type { RobotView, RunStatus, RunSummary } from "../src/wire/types";

function robot(name: string, state: RobotView["state"] = "idle", simulated = true): RobotView {
  return { robot: name, state, run: null, connected: state !== "lost", simulated, behaviors: [], cameras: [], reach: null, model: null };
}

const run = (status: RunStatus) => ({ status }) as RunSummary;

describe("the robots of the home page", () => {
  it("begin with those that somebody has to see after", () => {
    const all = [robot("b"), robot("a"), robot("c", "working"), robot("d", "holding"), robot("e", "working"), robot("f", "lost")];
    const names = robotsInOrder(all, new Set(["e"])).map((each) => each.robot);
    expect(names).toEqual(["f", "e", "d", "c", "a", "b"]);
  });

  it("are gone before they ask", () => {
    expect(standingOf(robot("a", "lost"), new Set(["a"]))).toBe("lost");
    expect(standingOf(robot("a", "holding"), new Set(["a"]))).toBe("asking");
  });
});

describe("the demo", () => {
  const there = { runs: [], robots: [], fleets: 0 };

  it("is offered while nothing goes on", () => {
    expect(offersDemo(there)).toBe(true);
    expect(offersDemo({ ...there, runs: [run("finished"), run("failed")], robots: [robot("a")] })).toBe(true);
    expect(offersDemo({ ...there, runs: [run("paused")] })).toBe(false);
  });

  it("is offered to nobody who has robots of their own", () => {
    expect(offersDemo({ ...there, robots: [robot("a", "idle", false)] })).toBe(false);
    expect(offersDemo({ ...there, fleets: 1 })).toBe(false);
  });
});

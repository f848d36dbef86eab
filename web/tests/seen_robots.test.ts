import { describe, expect, it } from "vitest";
import { activityOf, doingInWords, robotsAtWork } from "../src/building/at_work";
import { planOf } from "../src/building/plan";
import { seenRobots } from "../src/building/seen_robots";
import { begin, type Execution, type OpenDialogue, type RunState } from "../src/run/fold";
import type { RunStarted } from "../src/wire/types";
import { OFFICE } from "./office_scene";

const plan = planOf(OFFICE)!;
const ONE = "robot1-0a1b2c3d";
const TWO = "robot2-0a1b2c3d";

const leaves = ["F1-101", "F2-204"].map((place, index) => ({
  name: `go_to_${index + 1}`,
  kind: "behavior",
  parent: 0,
  behavior: "go_to",
  parameters: { place },
}));
const tree = { name: "rounds", nodes: [{ name: "all", kind: "and", parent: null }, ...leaves] };
const started = { type: "run_started", seq: 1, time: 0, robots: [ONE, TWO], scene: OFFICE, tree, options: {} } as unknown as RunStarted;

const drives = (node: string, held = false): Execution => ({ id: node, node, name: "go_to_2", step: 1, stepName: "", held });

function state(changes: Partial<RunState>): RunState {
  return { ...begin(started), ...changes };
}

const standing = { x: 2.2, y: 1.1, z: 3.5, yaw: 0, moving: true, seen_s: null };

describe("robots at work", () => {
  it("know their goal as the building calls it", () => {
    const [one, two] = robotsAtWork(state({ executions: new Map([[ONE, drives("/1")]]) }), plan);
    expect(one).toMatchObject({ name: "ROBOT1", task: "working", leaf: "go to 2", lost: false });
    expect(one?.goal).toMatchObject({ name: "204", floor: "F2", x: 2, y: 1 });
    expect(two).toMatchObject({ name: "ROBOT2", task: "idle", goal: null });
  });

  it("ask, are helped, hold, and end", () => {
    const talk = (helpAwaited: unknown) => new Map([["d", { opened: { robot: ONE }, helpAwaited } as unknown as OpenDialogue]]);
    const executions = new Map([[ONE, drives("/1", true)]]);
    const taskOf = (changes: Partial<RunState>) => robotsAtWork(state({ executions, ...changes }), plan)[0]?.task;
    expect(taskOf({ dialogues: talk(null) })).toBe("asking");
    expect(taskOf({ dialogues: talk({}) })).toBe("helped");
    expect(taskOf({})).toBe("held");
    expect(taskOf({ dialogues: talk(null), status: "aborted" })).toBe("over");
  });

  it("drive only while they move", () => {
    const [one] = robotsAtWork(state({ executions: new Map([[ONE, drives("/1")]]) }), plan);
    expect(activityOf(one!, true)).toBe("driving");
    expect(activityOf(one!, false)).toBe("waiting");
    expect(doingInWords(one!, "driving", "F1")).toBe("drives to 204 on F2");
    expect(doingInWords(one!, "waiting", "F2")).toBe("waits on its way to 204");
  });
});

describe("seenRobots", () => {
  const robots = robotsAtWork(state({ executions: new Map([[ONE, drives("/1")]]), lost: new Set([TWO]) }), plan);
  const about = { plan, past: false, atLeast: false };

  it("say where each is and what it does", () => {
    const [one, two] = seenRobots(robots, [standing, null], about);
    expect(one).toMatchObject({ activity: "driving", floor: "F2", where: "on F2, at 204", short: "→ 204", unseen: null });
    expect(two).toMatchObject({ floor: null, where: null });
  });

  it("say since when a robot was not seen, and never that it drives", () => {
    const gone = { ...standing, moving: false, seen_s: 12.3 };
    expect(seenRobots(robots, [gone], about)[0]).toMatchObject({ unseen: "last seen 12 s ago", short: "last seen 12 s ago" });
    expect(seenRobots(robots, [gone], { ...about, atLeast: true })[0]?.unseen).toBe("last seen more than 12 s ago");
    expect(seenRobots(robots, [gone], { ...about, past: true })[0]?.unseen).toBe("last seen 12 s before");
    expect(seenRobots(robots, [gone], about)[0]?.activity).not.toBe("driving");
  });

  it("do not take a robot for seen that the service has lost", () => {
    expect(seenRobots(robots, [null, { ...standing, moving: false }], about)[1]?.unseen).toBe("connection lost");
  });
});

// The numbers that can be plotted over a run: those of its events, and those of its recorded poses.
import { beforeAll, describe, expect, it } from "vitest";
import { createEventNumbers } from "../src/run/plots/event_numbers";
import { numbersIn, seriesOf } from "../src/run/plots/pose_numbers";
import { countUntil, told, unitOf } from "../src/run/plots/series";
import { decodeFrame } from "../src/run/scene/decode";
import type { Told } from "../src/wire/told";
import type { Layout } from "../src/wire/types";
import { frameBytes } from "./frame_bytes";
import { foldedRuns } from "./folded_runs.mjs";

let events: Told[] = [];

beforeAll(() => {
  events = foldedRuns([])[0]?.events ?? [];
}, 600_000);

const numbersOf = (some: readonly Told[]) => {
  const numbers = createEventNumbers();
  numbers.take(some);
  return numbers.series();
};

describe("numbers in events", () => {
  it("are found wherever they stand, in the order of their events", () => {
    const potential = numbersOf(events).find(({ name }) => name === "node started: candidates, green leg, potential");
    const choices = events.filter((event) => event.type === "node_started");
    const wanted = choices.flatMap((event) =>
      event.candidates.filter(({ name }) => name === "green_leg").map(({ potential: value }) => ({ time: event.time, seq: event.seq, value })),
    );
    expect(wanted.length).toBeGreaterThan(0);
    expect(potential?.points).toEqual(wanted);
  });

  it("are neither when nor which, nor what a run was begun with", () => {
    const ids = numbersOf(events).map(({ id }) => id);
    expect(ids.length).toBeGreaterThan(3);
    for (const id of ids) expect(id).not.toMatch(/\/(seq|time|seed|tree|scene|options)(\/|$)/);
    expect(new Set(ids).size).toBe(ids.length);
  });

  it("have their units, and points their axes", () => {
    const [begun] = events;
    const raised = { ...begun, type: "issue_raised", robot: "pr2", last_seen: [0.1, 0.2, 0.7], away_m: 2.5, detection: { probability: 0.9, center: [3, 4], measured: { force_n: 97 } } };
    const found = numbersOf([raised as unknown as Told]);
    expect(found.map(({ name, unit }) => [name, unit])).toEqual([
      ["issue raised: away", "m"],
      ["issue raised: detection, center, x", ""],
      ["issue raised: detection, center, y", ""],
      ["issue raised: detection, measured, force", "N"],
      ["issue raised: detection, probability", ""],
      ["issue raised: last seen, x", ""],
      ["issue raised: last seen, y", ""],
      ["issue raised: last seen, z", ""],
    ]);
  });

  it("are told for each robot where there are several", () => {
    const [begun] = events;
    const run = { ...begun, robots: ["left-0123abcd", "right-0123abcd"] };
    const steps = ["left-0123abcd", "right-0123abcd"].map((robot, step) => ({ ...begun, type: "step_started", robot, step, robots: undefined }));
    expect(numbersOf([run, ...steps] as unknown as Told[]).map(({ name }) => name)).toEqual([
      "step started: step of left",
      "step started: step of right",
    ]);
  });

  it("grow by what has come since", () => {
    const numbers = createEventNumbers();
    const grown: Told[] = [];
    for (const event of events) {
      grown.push(event);
      numbers.take(grown);
    }
    expect(numbers.series()).toEqual(numbersOf(events));
  });
});

describe("numbers in recorded poses", () => {
  const layout = { robot: "arm", joints: ["elbow_joint"], objects: [], robots: [], arms: [] } as unknown as Layout;

  it("are the gripper's, the tool's and the joints'", () => {
    expect(numbersIn(layout).map(({ name, unit }) => `${name} ${unit}`)).toEqual([
      "gripper: opening m",
      "tool, x m",
      "tool, y m",
      "tool, z m",
      "joint: elbow joint rad",
    ]);
  });

  it("are told of each arm where there are several", () => {
    const two = { ...layout, arms: [{ robot: "right-0123abcd", model: null, joints: ["wrist"] }] } as unknown as Layout;
    const numbers = numbersIn(two);
    expect(numbers.map(({ name }) => name)).toContain("gripper of arm: opening");
    const wrist = numbers.find(({ name }) => name === "joint of right: wrist");
    const frames = [frameBytes({ time: 1 }), frameBytes({ time: 2, arms: [{ joints: [0.5] }] })].map((each) => decodeFrame(each));
    expect(seriesOf(wrist as NonNullable<typeof wrist>, frames).points).toEqual([{ time: 2, value: 0.5, seq: null }]);
  });

  it("are read from the frames", () => {
    const frame = decodeFrame(frameBytes({ time: 2.5, joints: [0.25], opening: 0.04 }));
    const [opening] = numbersIn(layout);
    const series = seriesOf(opening as NonNullable<typeof opening>, [frame]);
    expect(series.points).toEqual([{ time: 2.5, value: frame.opening, seq: null }]);
  });
});

describe("a value", () => {
  it("has as many digits as tell something, and its unit", () => {
    expect([told(3, ""), told(0.123456, "m"), told(-0.5, "rad"), told(1500.04, ""), told(12345.678, "s")]).toEqual([
      "3",
      "0.1235 m",
      "-0.5 rad",
      "1500.04",
      "12345.68 s",
    ]);
    expect(unitOf("speed_m_s")).toEqual(["speed", "m/s"]);
    expect(unitOf("until")).toEqual(["until", ""]);
  });

  it("is that of the last point until then", () => {
    const points = [1, 2, 2, 5].map((time) => ({ time, value: 0, seq: null }));
    expect([0.9, 1, 2, 4.9, 9].map((time) => countUntil(points, time))).toEqual([0, 1, 3, 3, 4]);
  });
});

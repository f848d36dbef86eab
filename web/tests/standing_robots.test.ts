import { describe, expect, it } from "vitest";
import { createStandings, howLong, OLD_S } from "../src/building/standing";
import { decodeFrame } from "../src/run/scene/decode";
import { between } from "../src/run/scene/interpolate";
import { frameBytes } from "./frame_bytes";

type Robot = { x?: number; y?: number; z?: number; yaw?: number; age?: number };

const frame = (time: number, ...robots: Robot[]) => decodeFrame(frameBytes({ time, robots }));
const now = (time: number, silent_s = 0) => ({ time, silent_s, old_s: OLD_S });

describe("standings", () => {
  it("say where each robot is, and where it faces", () => {
    const [one, two] = createStandings().at(frame(1, { x: 2, y: -1, z: 3.5, yaw: 2 }, { age: Infinity }), now(1));
    expect(one).toMatchObject({ x: 2, y: -1, z: 3.5, seen_s: null });
    expect(one?.yaw).toBeCloseTo(2);
    expect(two).toBeNull();
  });

  it("tell who drives from who stands", () => {
    const standings = createStandings();
    let last: readonly ({ moving: boolean } | null)[] = [];
    for (let step = 0; step <= 40; step += 1) {
      last = standings.at(frame(step / 10, { x: step / 20 }, { x: 1 }), now(step / 10));
    }
    expect(last.map((each) => each?.moving)).toEqual([true, false]);
  });

  it("call a pose old that has not come for long, of one robot or of all", () => {
    const standings = createStandings();
    const shown = frame(20, { age: 0 }, { age: 12 });
    expect(standings.at(shown, now(20)).map((each) => each?.seen_s)).toEqual([null, 12]);
    expect(standings.at(shown, now(20, 7)).map((each) => each?.seen_s)).toEqual([7, 19]);
    expect(standings.at(shown, now(20, 7))[0]?.moving).toBe(false);
  });

  it("show at a moment of the past what was known then, and nothing of later", () => {
    const standings = createStandings();
    expect(standings.at(frame(20, {}), now(35))[0]?.seen_s).toBe(15);
    expect(standings.at(frame(20, {}), now(12))).toEqual([]);
    expect(standings.at(null, now(12))).toEqual([]);
  });
});

describe("robots between two frames", () => {
  it("are on the way from one to the other", () => {
    const half = between(frame(1, { x: 1, z: 0 }), frame(1.1, { x: 1.1, z: 0.2 }), 0.5);
    expect(half.robots[0]?.pose[0]).toBeCloseTo(1.05);
    expect(half.robots[0]?.pose[2]).toBeCloseTo(0.1);
  });

  it("stay, and grow old, where nothing came in between", () => {
    const half = between(frame(10, { x: 1 }), frame(30, { x: 5 }), 0.5);
    expect(half.robots[0]?.pose[0]).toBe(1);
    expect(half.robots[0]?.age).toBe(10);
  });

  it("appear with the frame that first has them", () => {
    expect(between(frame(1, { age: Infinity }), frame(1.1, { x: 4 }), 0.9).robots[0]?.age).toBe(Infinity);
  });
});

describe("howLong", () => {
  it("is in seconds, then in minutes", () => {
    expect([3.9, 119, 200, 86_400].map(howLong)).toEqual(["3 s", "119 s", "3 min", "24 h"]);
  });
});

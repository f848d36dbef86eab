import { describe, expect, it } from "vitest";
import { shapesOf } from "../src/question/detection_overlay";
import { faultInWords, robotName, spoken } from "../src/question/fault_words";
import { readRunClock, runTime } from "../src/state/run_clock";
import type { Detection } from "../src/wire/types";

const about = { issue: "dropped", object: "yellow_bar", name: "bar", robot: "pr2-0a1b2c3d" };

describe("a fault in words", () => {
  it("speaks of the part, and not of the kind", () => {
    expect(faultInWords(about)).toBe("The yellow bar is no longer in the gripper.");
  });

  it("falls back to the leaf's name where a kind is unknown", () => {
    expect(faultInWords({ ...about, issue: "door_closed", object: null })).toBe(
      "The robot could not go on with “bar” (door closed).",
    );
  });

  it("leaves out what only tells equal names apart", () => {
    expect(spoken("collect cup_of_tea--0afba7d8")).toBe("collect cup of tea");
    expect(spoken("part--12")).toBe("part  12");
  });

  it("leaves out the number that a run gives a robot", () => {
    expect(robotName("pr2-0a1b2c3d")).toBe("PR2");
    expect(robotName("arm_of_lab-two")).toBe("arm of lab two");
  });
});

describe("a detection on a picture", () => {
  const detection: Detection = {
    camera: "forearm",
    size_px: [160, 120],
    center: [39.5, 79.5],
    expected: [79.5, 59.5],
    tolerance_px: 10,
    area_px: 314,
    felt: false,
    part: null,
    probability: null,
    explanation: "",
    guesses: [],
    between: [],
    robot: null,
    measured: {},
  };

  it("is scaled to the picture, which may be an enlarged one", () => {
    const shapes = shapesOf(detection, { width: 320, height: 240 });
    expect(shapes?.expected).toEqual({ x: 160, y: 120, half: 20 });
    expect(shapes?.seen).toMatchObject({ x: 80, y: 160 });
    expect(shapes?.seen?.radius).toBeCloseTo(20, 1);
  });

  it("is not drawn where its pixels are not those of a known size", () => {
    expect(shapesOf({ ...detection, size_px: null }, { width: 320, height: 240 })).toBeNull();
    expect(shapesOf({ ...detection, center: null, expected: null }, { width: 1, height: 1 })).toBeNull();
  });
});

describe("a run's clock", () => {
  it("runs at most at real time while somebody is asked", () => {
    readRunClock("fast", 10, 100);
    expect(runTime("fast", 4, 102)).toBe(12);
    expect(runTime("fast", "max", 102)).toBe(12);
    expect(runTime("fast", 0.5, 102)).toBe(11);
  });

  it("never goes back for an event that comes late", () => {
    readRunClock("late", 10, 100);
    readRunClock("late", 9, 101);
    expect(runTime("late", 1, 101)).toBe(11);
  });
});

// How wide the parts of a run's page become.
import { describe, expect, it } from "vitest";
import { camerasOf } from "../src/run/camera_record";
import { AS_MADE, sceneDrawnTo, SIDE_PX, sideDrawnTo, styleOf, withScene, withSide } from "../src/run/run_layout";

describe("the layout of a run's page", () => {
  it("follows what is drawn, within what can be read", () => {
    expect(sceneDrawnTo(AS_MADE, 506, 1424).scene).toBeCloseTo(0.5);
    expect(sceneDrawnTo(AS_MADE, 0, 1424).scene).toBe(0.25);
    expect(sideDrawnTo(AS_MADE, 1000, 1506).side).toBe(500);
    expect(sideDrawnTo(AS_MADE, 1500, 1506).side).toBe(SIDE_PX.least);
    expect(withScene(AS_MADE, 2).scene).toBe(0.75);
    expect(withSide(AS_MADE, 5_000).side).toBe(SIDE_PX.most);
  });

  it("leaves the side to the style sheet until somebody has changed it", () => {
    expect(styleOf(AS_MADE)).toEqual({ "--scene-width": "0.5fr", "--tree-width": "0.5fr" });
    expect(styleOf({ scene: 0.6, side: 320 })).toMatchObject({ "--side-width": "320px" });
  });
});

describe("the cameras that are shown", () => {
  const kept = [{ robot: "a", camera: "wrist", time: 1, picture: "p" }];

  it("are those of the robot, and those that pictures are kept of", () => {
    expect(camerasOf(["forearm", "head"], [])).toEqual(["head", "forearm"]);
    expect(camerasOf(["head"], kept)).toEqual(["head", "wrist"]);
  });

  it("are an arm's where nothing is known yet", () => {
    expect(camerasOf([], [])).toEqual(["head", "forearm"]);
  });
});

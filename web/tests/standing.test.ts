import { describe, expect, it } from "vitest";
import { connectedOnes, robotsOfRequest } from "../src/run/start/standing";
import type { RobotView } from "../src/wire/types";

function robot(name: string, change: Partial<RobotView> = {}): RobotView {
  const view: RobotView = {
    robot: name, connected: true, simulated: false, behaviors: [], cameras: [], reach: null, model: null, run: null, state: "idle",
  };
  return { ...view, ...change };
}

describe("the robots of a live run", () => {
  it("are among those that are connected and that the service does not run itself", () => {
    const known = [robot("arm"), robot("gone", { connected: false }), robot("pr2-1", { simulated: true })];
    expect(connectedOnes(known).map((each) => each.robot)).toEqual(["arm"]);
  });

  it("are a list where the scene says nothing of them", () => {
    expect(robotsOfRequest(["b", "a"], { left: "c" }, [])).toEqual(["b", "a"]);
  });

  it("are told by place where the scene says who stands where, without those of which there is none", () => {
    const standing = { left: "a", right: "", elsewhere: "c" };
    expect(robotsOfRequest(["b"], standing, ["left", "right", "middle"])).toEqual({ left: "a" });
  });
});

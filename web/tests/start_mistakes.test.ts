import { describe, expect, it } from "vitest";
import { atTheirFields } from "../src/run/start/start_mistakes";

describe("a refused start", () => {
  it.each([
    ["body.seed: must be greater than or equal to 0", "seed"],
    ["body.max_attempts: must be a whole number", "max_attempts"],
    ["body.speed: must be greater than 0 or 'max'", "speed"],
    ["body.robots.0: must be text", "robots"],
    ["there is no world 'moon'; there are 'tabletop'", "world"],
    ["a run in the world 'live' needs 'robots', the names of connected ones", "robots"],
    ["'robots': the scene 'pair' has no robot 'lft'; it has 'left', 'right'", "robots"],
    ["the robot 'r1' is busy with run 7", "robots"],
    ["no robot 'r1' is connected", "robots"],
    ["scenario 'eket_paper' is for the tree 'eket', not 'tea_table'", "scenario"],
    ["there is no scenario 'x'", "scenario"],
    ["there is no tree 'x'", "tree"],
    ["there is no site 1a2b3c4d; it may have been closed", "world"],
    ["tree 'x' names no scene, and the world 'w' needs one", "tree"],
    ["the journal cannot be written", "form"],
    ["body.unknown: Extra inputs are not permitted", "form"],
  ])("%j is said at %s", (sentence, field) => {
    expect(Object.keys(atTheirFields([sentence]))).toEqual([field]);
  });

  it("says every mistake as a sentence", () => {
    expect(atTheirFields(["body.seed: too small", "body.seed: not whole", "no room"])).toEqual({
      seed: "Too small. Not whole.",
      form: "No room.",
    });
  });
});

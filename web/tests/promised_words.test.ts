// What a promise card says of help for the way of a base: what was asked, not always a way to be cleared.
import { describe, expect, it } from "vitest";
import { promised, watchedFor } from "../src/question/promised_words";
import type { Detection } from "../src/wire/types";

const LASER = { camera: "laser" } as Detection;
const about = (issue: string) => ({ issue, detection: LASER, object: null, name: "go_to" });

describe("help that was promised", () => {
  it.each([
    ["blocked", "would clear the way", "The robot watches until its way is free."],
    ["door_closed", "would open the door", "The robot watches until it sees the door open."],
    ["elevator_help", "would call the elevator and press its button", "The robot watches until it sees the elevator open."],
    ["wrong_floor", "would press the button for its floor", "The robot waits until it is at its floor."],
  ])("for %s is what was asked for", (issue, promise, expected) => {
    expect(promised(about(issue), "clear_way")).toBe(promise);
    expect(watchedFor(about(issue), "clear_way")).toBe(expected);
  });

  it("speaks of an arm where there is one, and of parts", () => {
    const arm = { issue: "blocked", detection: null, object: "yellow_bar", name: "bar" };
    expect(watchedFor(arm, "clear_way")).toBe("The robot watches until nothing is in the way of its arm.");
    expect(promised(arm, "put_back")).toBe("would put the yellow bar back on the table");
  });
});

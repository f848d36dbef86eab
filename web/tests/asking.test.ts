// What people ask robots for: places that they write, times that they are told, steps at a touch screen.
import { describe, expect, it } from "vitest";
import { byFloor, placeMeant } from "../src/requests/places";
import { when } from "../src/requests/when";
import { NO_WISH, requestOf } from "../src/requests/wish";
import { followed } from "../src/requests/use_asking";
import type { RequestView } from "../src/wire/types";
import { type Asked, nextStep, readBackOf, textOf, wishOf } from "../src/touch/steps";

const PLACES = ["F1/101", "F1/kitchen", "F1/meeting room", "F2/203", "F2/kitchen"];

describe("a place that somebody writes", () => {
  it.each([
    ["F1/101", "F1/101"],
    ["f1 101", "F1/101"],
    [" 203 ", "F2/203"],
    ["Room 203", "F2/203"],
    ["meeting room", "F1/meeting room"],
    ["F2 kitchen", "F2/kitchen"],
  ])("%s is meant", (written, place) => {
    expect(placeMeant(written, PLACES)).toBe(place);
  });

  it("is not guessed", () => {
    expect(placeMeant("999", PLACES)).toEqual({ mistake: "There is no place “999” here." });
    expect(placeMeant("kitchen", PLACES)).toEqual({
      mistake: "“kitchen” is on several floors: choose F1 kitchen or F2 kitchen.",
    });
  });

  it("is kept by its floor", () => {
    expect([...byFloor(PLACES)].map(([floor, there]) => [floor, there.length])).toEqual([
      ["F1", 3],
      ["F2", 2],
    ]);
  });
});

describe("a moment of the building's clock", () => {
  const today = new Date(2026, 5, 1, 14, 20, 0);

  it.each([
    [340, 1, "in about 4 minutes, at 14:24"],
    [340, 4, "in about 1 minute, at 14:21"],
    [90, 1, "in less than a minute, at 14:20"],
    [340, "max", "in about 4 minutes"],
    [100 + 3 * 3600, 1, "at 17:20"],
    [100 + 10 * 3600, 1, "tomorrow at 00:20"],
    [100 + 24 * 3600, 1, "tomorrow at 14:20"],
    [100 + 3 * 24 * 3600, 1, "on Thursday at 14:20"],
    [100 + 7 * 24 * 3600, 1, "on Monday 8 June at 14:20"],
  ] as const)("%d s at speed %s is said by people's", (moment, speed, said) => {
    expect(when(moment, { now: 100, speed }, today)).toBe(said);
  });
});

describe("at a touch screen", () => {
  it("one thing is asked after the other, and read back", () => {
    const asked: Asked = { kind: "transport", answers: [] };
    expect(nextStep(asked)).toBe("what");
    expect(nextStep({ ...asked, answers: ["this", "F1/101"] })).toBe("destination");
    const whole: Asked = { ...asked, answers: ["this", "F1/101", "F2/203"] };
    expect(nextStep(whole)).toBe(null);
    expect(readBackOf(wishOf(whole, null))).toBe("I am to bring this from F1 101 to F2 203. Is that right?");
    expect(requestOf(wishOf(whole, null), 0, "ab12")).toMatchObject({ name: "thing--ab12", what: "this" });
    expect([textOf(whole), textOf({ ...whole, answers: ["tea"] })]).toEqual([null, "tea"]);
  });

  it.each([
    [{ kind: "escort", answers: ["F2/203"] }, "show you the way from F1 101 to F2 203"],
    [{ kind: "go_to_room", answers: ["F2/203"] }, "come to F2 203"],
    [{ kind: "deliver_message", answers: ["Lunch.", "F2/203"] }, "tell F2 203 that “Lunch.”"],
  ] as const)("what is wanted is read back", (asked, said) => {
    expect(readBackOf(wishOf(asked, "F1/101"))).toBe(`I am to ${said}. Is that right?`);
  });

  it("a message is read back, and asked for, with the marks that robots say", () => {
    const wish = wishOf({ kind: "deliver_message", answers: ['Say "hello" to «Zoë» ', "F2/203"] }, null);
    expect(readBackOf(wish)).toBe("I am to tell F2 203 that “Say 'hello' to 'Zoë'”. Is that right?");
    expect(requestOf(wish, 0, "ab12")).toMatchObject({ message: "Say 'hello' to 'Zoë'" });
    expect(requestOf({ ...NO_WISH, kind: "escort", person: "„Zoë“" }, 0, "ab12")).toMatchObject({ person: "'Zoë'" });
  });

  it("whoever asks is shown the way from where the robot is", () => {
    const wish = wishOf({ kind: "escort", answers: ["F2/203"] }, "F1/101");
    expect(requestOf(wish, 0, "ab12")).toEqual({
      kind: "escort",
      name: "escort--ab12",
      person: "whoever asked",
      origin: "F1/101",
      destination: "F2/203",
    });
  });
});

describe("what was asked for", () => {
  const request = (name: string, status: string) => ({ name, status }) as RequestView;
  const booked = request("r1", "booked");

  it("is followed as it is known last", () => {
    const done = request("r1", "done");
    expect(followed({ phase: "booked", request: booked }, [request("r2", "failed"), done])).toBe(done);
    expect(followed({ phase: "booked", request: booked }, null)).toBe(booked);
    expect(followed({ phase: "nothing" }, [done])).toBe(null);
  });

  it("is not what was refused under its name before", () => {
    expect(followed({ phase: "booked", request: booked }, [request("r1", "refused")])).toBe(booked);
  });
});

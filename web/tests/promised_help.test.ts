import { beforeEach, describe, expect, it, vi } from "vitest";

vi.stubGlobal("window", globalThis);
vi.stubGlobal("localStorage", { getItem: () => null, setItem: () => undefined, removeItem: () => undefined });
vi.stubGlobal("location", { host: "service", protocol: "http:", pathname: "/", search: "", hash: "" });

const { dialogueOf, takeDialogueEvent, takeDialogues } = await import("../src/state/questions");
const { seenBy } = await import("../src/question/help_camera");

const about = {
  seq: 1,
  time: 10,
  wall_time: "",
  run: "r",
  node: "/0",
  name: "cup",
  dialogue: "d",
  robot: "pr2",
  issue: "missed",
  object: "cup",
};
const AWAITED = { ...about, type: "help_awaited", help: "put_back", guess: null, helper: "anna", until: 40 };
const UNSEEN = { ...about, help: "put_back", felt: null, blind: null, picture: "p", detection: null, time: 15 };

const take = (event: object) => takeDialogueEvent(event as never, "anna");

beforeEach(() => {
  takeDialogues([], new Map());
  take({ ...about, type: "dialogue_opened", scripted: false });
  take(AWAITED);
});

describe("promised help", () => {
  it("is waited for as long as the robot said", () => {
    expect(dialogueOf("d")?.help).toEqual({
      help: "put_back",
      helper: "anna",
      until: 40,
      within_s: 30,
      reported_by: null,
      at_a_word: true,
    });
  });

  it("is looked for at a word, and goes on to be awaited while it is not seen", () => {
    take({ ...about, type: "help_reported", help: "put_back", helper: "ben", author: null });
    expect(dialogueOf("d")?.help?.reported_by).toBe("ben");
    take({ ...UNSEEN, type: "help_not_seen_yet", sight: "unmoved" });
    expect(dialogueOf("d")?.help?.reported_by).toBeNull();
    expect(dialogueOf("d")?.awaiting).toBe("help");
    expect(dialogueOf("d")?.unseen_help).toEqual({ time: 15, picture: "p", detection: null });
  });

  it("keeps the last picture where a later look has none", () => {
    take({ ...UNSEEN, type: "help_not_seen_yet", sight: "unmoved" });
    take({ ...UNSEEN, type: "help_not_seen", picture: null });
    expect(dialogueOf("d")?.unseen_help?.picture).toBe("p");
    expect(dialogueOf("d")?.help).toBeNull();
  });

  it("is awaited no more once it is taken back", () => {
    take({ ...about, type: "promise_taken_back", help: "put_back", helper: "anna", author: null });
    expect(dialogueOf("d")?.help).toBeNull();
    expect(dialogueOf("d")?.awaiting).toBeNull();
  });

  it("cannot be said to be done where the robot was only told where it is", () => {
    take({ ...AWAITED, help: "tell_place", guess: "at 101" });
    expect(dialogueOf("d")?.help?.at_a_word).toBe(false);
  });

  it("is seen by the camera that is to see it, and by none of a base", () => {
    const help = dialogueOf("d")?.help ?? null;
    expect(seenBy({ help, detection: null })).toBe("head");
    expect(seenBy({ help: help && { ...help, help: "hand_over" }, detection: null })).toBe("forearm");
    expect(seenBy({ help: help && { ...help, help: "charge" }, detection: null })).toBeNull();
    const byLaser = { camera: "laser" } as never;
    expect(seenBy({ help: help && { ...help, help: "clear_way" }, detection: byLaser })).toBeNull();
  });
});

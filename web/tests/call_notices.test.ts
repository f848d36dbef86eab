// How calls look on a device, and what a trial of them comes to.
import { describe, expect, it } from "vitest";
import { deviceName } from "../src/calling/device_name";
import { type State, verdict } from "../src/calling/findings";
import { callNotice, lostNotice, OVER, overNotice } from "../src/calling/notices";
import { takeSentences } from "../src/words/said";

const CALL = { dialogue: "d", run: "r", robot: "pr2-1a2b3c4d", text: "May I go on?", sentences: [], urgent: false };

describe("a call", () => {
  it("names the robot without the number of its run, and says the question", () => {
    const { title, options } = callNotice(CALL, false);
    expect(title).toBe("PR2 asks for help");
    expect(options).toMatchObject({ body: "May I go on?", tag: "d", requireInteraction: true, silent: false });
    expect(options.vibrate).toBeDefined();
  });

  it("is quiet where the page is before somebody's eyes", () => {
    const { options } = callNotice(CALL, true);
    // Browsers refuse one that is silent and vibrates.
    expect(options).toMatchObject({ silent: true });
    expect(options).not.toHaveProperty("vibrate");
  });

  it("says so where help is needed now", () => {
    expect(callNotice({ ...CALL, urgent: true }, false).title).toBe("PR2 needs help now");
  });

  it("says the question in the reader's language, of what it is made of", () => {
    takeSentences({ "Can you open the door?": "Können Sie die Tür öffnen?" }, {});
    const sentences = [{ key: "Can you open the door?", args: {} }];
    const { options } = callNotice({ ...CALL, text: "Can you open the door?", sentences }, false);
    takeSentences({}, {});
    expect(options.body).toBe("Können Sie die Tür öffnen?");
  });

  it("that is over is told under one tag, without a sound", () => {
    const { title, options } = overNotice({ type: "withdrawn", dialogue: "d", robot: "pr2", text: "ben answered yes." });
    expect(title).toBe("pr2: you are not needed now");
    expect(options).toMatchObject({ tag: OVER, silent: true, body: "ben answered yes." });
  });
});

describe("a robot that is gone", () => {
  it("is told by what it is called off by", () => {
    const { title, options } = lostNotice({ dialogue: "d", robot: "pr2-1a2b3c4d" }, false);
    expect(title).toBe("PR2 is gone");
    expect(options).toMatchObject({ tag: "d", requireInteraction: true, silent: false });
  });
});

describe("a trial", () => {
  const found = (states: Record<string, State>) =>
    verdict(Object.entries(states).map(([what, state]) => ({ what, state, words: "" })));
  const all: Record<string, State> = { "Your turn": "well", Sound: "well", "A push all the way": "well" };

  it("says when a device calls", () => {
    expect(found(all)).toMatchObject({ state: "well", words: "This device calls you, whether this page is open or not." });
    expect(found({ ...all, "A push all the way": "bad" }).words).toBe("This device calls you only as long as this page is open.");
    expect(found({ ...all, Sound: "bad" }).words).toContain("makes no sound");
  });

  it("never says that a device calls which does not", () => {
    expect(found({ ...all, Sound: "bad", "A push all the way": "bad" })).toMatchObject({ state: "bad", words: "This device does not call you." });
    expect(found({ ...all, "Your turn": "bad" })).toMatchObject({ state: "bad" });
    expect(found({ ...all, "Screen stays on": "bad" })).toMatchObject({ state: "bad" });
  });
});

describe("a device", () => {
  it("is told by its system and browser", () => {
    const pixel = "Mozilla/5.0 (Linux; Android 14; Pixel 8) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0 Mobile Safari/537.36";
    expect(deviceName(pixel)).toBe("Android, Chrome");
    expect(deviceName("Mozilla/5.0 (iPhone; CPU iPhone OS 17_5) AppleWebKit/605.1 Version/17.5 Mobile Safari/604.1")).toBe("iPhone, Safari");
    expect(deviceName("something")).toBe("Device");
  });
});

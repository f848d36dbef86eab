import { describe, expect, it } from "vitest";
import { begunWith, changed, endOfDifference, goneOn, redone, type TextHistory, undone } from "../src/document/text_history";

const typed = (history: TextHistory, text: string, atMs: number) => goneOn(history, text, "typing", atMs);

describe("the history of a text", () => {
  it("goes back over what was typed at a time, and over each change in the drawing", () => {
    let history = typed(typed(begunWith("a"), "ab", 0), "abc", 400);
    history = changed(history, "aXc");
    history = typed(history, "aXcd", 600);
    expect(history.past).toEqual(["a", "abc", "aXc"]);
    history = undone(undone(history));
    expect(history.text).toBe("abc");
    history = undone(history);
    expect(history.text).toBe("a");
    expect(undone(history)).toBe(history);
    expect(redone(redone(redone(history))).text).toBe("aXcd");
  });

  it("begins a new step after a pause, and forgets what was undone once something new is done", () => {
    const history = typed(typed(begunWith("a"), "ab", 0), "abc", 1500);
    expect(undone(history).text).toBe("ab");
    const other = changed(undone(history), "abX");
    expect(redone(other)).toBe(other);
    expect(changed(other, "abX")).toBe(other);
  });

  it("tells typing from moving with keys", () => {
    const history = goneOn(goneOn(typed(begunWith("a"), "ab", 0), "ab1", "moving", 10), "ab2", "moving", 20);
    expect(undone(history).text).toBe("ab");
    expect(undone(undone(history)).text).toBe("a");
  });

  it("keeps no more than there is room for", () => {
    let history = begunWith("0");
    for (let count = 1; count < 500; count++) history = changed(history, String(count));
    expect(history.past).toHaveLength(200);
    const long = changed(changed(begunWith("x".repeat(10_000_000)), "y".repeat(10_000_000)), "z");
    expect(long.past).toHaveLength(1);
  });

  it.each([
    ["abXd", "abcd", 3],
    ["abd", "abcd", 2],
    ["aaa", "aa", 3],
    ["", "abc", 0],
  ])("leads in %j, after %j, behind what is different", (text, before, offset) => {
    expect(endOfDifference(text, before)).toBe(offset);
  });
});

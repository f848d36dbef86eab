// Which question a helper has before them first.
import { describe, expect, it } from "vitest";
import { inOrder, toShow } from "../src/question/order";

interface Asked {
  dialogue: string;
  claimed_by: string | null;
  opened: number;
  prompt: never;
}

function asked(dialogue: string, opened: number, to: string | null = null, claimed_by: string | null = null): Asked {
  return { dialogue, claimed_by, opened, prompt: { to } as never };
}

const never = () => Infinity;
const order = (open: readonly Asked[], due: (each: Asked) => number = never) =>
  inOrder(open, "anna", due).map(({ dialogue }) => dialogue);

describe("the questions of a helper", () => {
  it("begin with what they are on and what they are asked, and end with what others are on", () => {
    const open = [asked("bobs", 1, null, "bob"), asked("to bob", 2, "bob"), asked("all", 3), asked("to anna", 4, "anna")];
    expect(order([...open, asked("annas", 5, "bob", "anna")])).toEqual(["annas", "all", "to anna", "to bob", "bobs"]);
  });

  it("come the most urgent first, and the oldest where none is", () => {
    const due = new Map([["late", 100], ["soon", 20], ["as soon", 20.4]]);
    const open = [asked("never", 1), asked("late", 2), asked("as soon", 3), asked("soon", 4)];
    expect(order(open, ({ dialogue }) => due.get(dialogue) ?? Infinity)).toEqual(["as soon", "soon", "late", "never"]);
    expect(order([asked("b", 2), asked("a", 1)])).toEqual(["a", "b"]);
  });
});

describe("the question that is shown", () => {
  it("stays while it is read, though a more urgent one comes", () => {
    const open = [asked("urgent", 2), asked("read", 1)];
    expect(toShow(open, "anna", "read")?.dialogue).toBe("read");
    expect(toShow(open, "anna", null)?.dialogue).toBe("urgent");
    expect(toShow([], "anna", "read")).toBeNull();
  });

  it("goes once it is gone, or once it is another's", () => {
    const open = [asked("urgent", 2), asked("read", 1, null, "bob")];
    expect(toShow(open, "anna", "read")?.dialogue).toBe("urgent");
    expect(toShow(open, "anna", "closed")?.dialogue).toBe("urgent");
  });
});

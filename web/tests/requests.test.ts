// What is said of requests, and what a filled-in form asks for.
import { describe, expect, it } from "vitest";
import { exampleFor } from "../src/requests/example";
import { expectation, isOver, wanted } from "../src/requests/request_words";
import { type SiteClock, when, within } from "../src/requests/when";
import { soon } from "../src/requests/followed";
import { missing, NO_WISH, requestOf, type Wish, withinWhat } from "../src/requests/wish";
import type { RequestStatus, RequestView } from "../src/wire/types";

const MAIL: Wish = { ...NO_WISH, what: " the mail ", origin: "F1/101", destination: "F2/203" };

function request(what: object, status: RequestStatus = "booked", done = 300): RequestView {
  const expected = { robot: "robot1", place: "F1/101", begins_s: 0, done_s: done, late_s: 0 };
  return { name: "r", site: "s", what: { ...what }, status, reason: null, expected, waits: null } as RequestView;
}

const at = (now: number, speed: SiteClock["speed"] = 1): SiteClock => ({ now, speed });

describe("words of requests", () => {
  it.each([
    [{ kind: "transport", what: "mail", origin: "F1/101", destination: "F2/203" }, "Bring mail from F1 101 to F2 203"],
    [{ kind: "transport", what: "this", origin: "F1/101", destination: "F2/203" }, "Bring this from F1 101 to F2 203"],
    [{ kind: "deliver_message", message: "Lunch.", place: "F1/101" }, "Tell “Lunch.” at F1 101"],
    [{ kind: "go_to_room", place: "F1/101" }, "Come to F1 101"],
    [{ kind: "escort", person: "Ann", origin: "hall", destination: "F1/101" }, "Show Ann the way from hall to F1 101"],
  ])("say what is wanted", (what, said) => {
    expect(wanted(request(what))).toBe(said);
  });

  it("say when an open request is expected, and nothing of one that is over", () => {
    const going = { kind: "go_to_room", place: "F1/101" };
    expect(expectation(request(going), at(60))).toBe("robot1, done in about 4 minutes");
    expect(expectation(request(going, "under_way"), at(290))).toBe("robot1, done in less than a minute");
    expect(expectation(request(going, "done"), at(60))).toBe("");
    expect(isOver(request(going, "failed"))).toBe(true);
  });

  it("say that nobody knows until when, once a robot is late or waits for people", () => {
    const late = request({ kind: "go_to_room", place: "F1/101" }, "under_way");
    const waits = { robot: "robot1", dialogue: "d", headline: "Can you open the door?", helper: null };
    const earliest = "robot1, done in about 4 minutes at the earliest";
    expect(expectation({ ...late, waits }, at(60))).toBe(earliest);
    expect(expectation({ ...late, expected: { ...late.expected!, late_s: 5 } }, at(60))).toBe(earliest);
    expect(expectation(late, at(400))).toBe("robot1, done in less than a minute at the earliest");
    expect(soon({ ...late, waits }, { now: 60, speed: "max" })).toContain("at the earliest in about 4 minutes");
    expect(soon(late, { now: 60, speed: "max" })).toContain("be done with it in about 4 minutes");
    expect(expectation({ ...late, status: "done", waits }, at(400))).toBe("");
  });

  it("say how long that is", () => {
    expect(within(60)).toBe("in about 1 minute");
  });

  it("say the same in a list and of the one that is followed, by people's own clock", () => {
    const going = request({ kind: "go_to_room", place: "F1/101" }, "under_way", 1_320);
    for (const [speed, left] of [[1, "in about 22 minutes"], [5, "in about 4 minutes"], [50, "in less than a minute"], ["max", "in about 22 minutes"]] as const) {
      expect(expectation(going, at(0, speed))).toBe(`robot1, done ${left}`);
      expect(soon(going, at(0, speed))).toContain(left);
      expect(when(1_320, at(0, speed), new Date(2026, 10, 30, 12))).toContain(left);
    }
    expect(expectation(going, null)).toBe("");
  });
});

describe("a filled-in form", () => {
  it("says what is missing", () => {
    expect(missing(NO_WISH, 100)).toBe("Say what is to be brought.");
    expect(missing({ ...NO_WISH, what: "mail" }, 100)).toBe("Say from where, and to where.");
    expect(missing({ ...MAIL, destination: "F1/101" }, 100)).toBe("It is there already: choose another place.");
    expect(missing({ ...MAIL, within: "soon" }, 100)).toContain("in how many minutes");
    expect(missing({ ...NO_WISH, kind: "deliver_message", message: "x" }, 100)).toBe("Say where.");
    expect(missing(MAIL, 100)).toBe("");
  });

  it("says in its own words how many minutes may be given", () => {
    for (const within of ["1e9", "0", "-5", "Infinity", "1000001"]) {
      expect(missing({ ...MAIL, within }, 100)).toContain("with a number up to 1,000,000, or leave that empty");
    }
    expect(missing({ ...MAIL, within: "1000000" }, 100)).toBe("");
    expect(missing({ ...MAIL, within: "11" }, 1e8 - 600)).toContain("up to 10,");
  });

  it("says that minutes are the building's, where those are others than people's own", () => {
    expect(withinWhat(at(0))).toBe("Within minutes (optional)");
    expect(withinWhat(at(0, 2.5))).toBe("Within minutes of the building's clock, which goes 2.5 times as fast as yours (optional)");
    expect(withinWhat(at(0, "max"))).toBe("Within minutes of the building's clock (optional)");
  });

  it("is a request by the building's clock", () => {
    expect(requestOf({ ...MAIL, within: "5" }, 100, "ab12")).toEqual({
      kind: "transport",
      name: "the_mail--ab12",
      what: "the mail",
      origin: "F1/101",
      destination: "F2/203",
      latest_s: 400,
    });
    expect(requestOf({ ...NO_WISH, kind: "go_to_room", place: "F1/101" }, 0, "ab12")).toEqual({
      kind: "go_to_room",
      name: "visit--ab12",
      place: "F1/101",
    });
    expect(requestOf({ ...MAIL, what: "3 Schlüssel" }, 0, "x")["name"]).toBe("Schl_ssel--x");
    expect(requestOf({ ...MAIL, what: "钥匙" }, 0, "x")["name"]).toBe("thing--x");
  });
});

describe("an example of what to say", () => {
  const places = ["F1/101", "F1/102", "F2/203"];

  it("says \"this\" only where it is known where that is", () => {
    expect(exampleFor(places, "F1/101")).toBe("bring this to F1 102");
    expect(exampleFor(places, null)).toBe("bring the mail from F1 101 to F2 203");
  });
});

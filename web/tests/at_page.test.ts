// Whether somebody is at a page: what is told of it, and how often.
import { beforeEach, describe, expect, it } from "vitest";
import { AGAIN_MS, AtPage, type Presence } from "../src/calling/at_page";

let now: number;
let told: Presence[];
let timer: { at: number; then: () => void } | null;

const watch = {
  tell: (presence: Presence) => void told.push(presence),
  now: () => now,
  later: (ms: number, then: () => void) => {
    const mine = { at: now + ms, then };
    timer = mine;
    return () => {
      if (timer === mine) timer = null;
    };
  },
};

/** Time goes by, and whatever comes due in it. */
function pass(ms: number): void {
  const end = now + ms;
  while (timer !== null && timer.at <= end) {
    now = timer.at;
    const { then } = timer;
    timer = null;
    then();
  }
  now = end;
}

beforeEach(() => {
  now = 1000;
  told = [];
  timer = null;
});

describe("a page that somebody is at", () => {
  it("says so now and then while they do something", () => {
    const page = new AtPage(watch, true);
    expect(page.presence).toBe("active");
    for (let each = 0; each < 100; each++) {
      pass(AGAIN_MS / 10);
      page.acted();
    }
    expect(told).toEqual(Array(10).fill("active"));
  });

  it("is left once nobody has done anything for a while, and no longer as soon as somebody does", () => {
    const page = new AtPage(watch, true);
    page.awayAfter(60);
    pass(59_999);
    expect(page.presence).toBe("active");
    pass(1);
    expect(page.presence).toBe("away");
    page.acted();
    expect(told).toEqual(["away", "active"]);
    pass(60_000);
    expect(told).toEqual(["away", "active", "away"]);
  });

  it("is left at once where nobody sees it", () => {
    const page = new AtPage(watch, true);
    page.shows(false);
    page.acted();
    expect(told).toEqual(["away"]);
    page.shows(true);
    expect(told).toEqual(["away", "active"]);
  });

  it("is opened by nobody where it is not seen", () => {
    expect(new AtPage(watch, false).presence).toBe("away");
    expect(timer).toBeNull();
  });
});

describe("a page that stands with a robot", () => {
  it("always listens beside it", () => {
    const page = new AtPage(watch, true);
    page.stands("beside_robot");
    page.shows(false);
    pass(3_600_000);
    expect(page.presence).toBe("beside");
    expect(told).toEqual(["beside"]);
    page.stands(null);
    expect(told).toEqual(["beside", "away"]);
  });

  it("shows nobody a question before it", () => {
    const page = new AtPage(watch, true);
    page.stands("before_robot");
    page.acted();
    expect(page.presence).toBe("away");
    expect(told).toEqual(["away"]);
  });
});

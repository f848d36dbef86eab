// The rows of a fleet's chart, and what is known of its past.
import { describe, expect, it } from "vitest";
import { changeInWords, chartRows } from "../src/fleet/chart_rows";
import { expectation } from "../src/requests/request_words";
import { eventsUntil, type FleetEvent, isOfFleet, requestsAfter } from "../src/fleet/fleet_past";
import type { Event, FleetRobot } from "../src/wire/types";

const ONE = "robot1-0a1b2c3d";
const TWO = "robot2-0a1b2c3d";

let seq = 0;
const event = (type: string, at_s: number, fields: object): FleetEvent =>
  ({ type, seq: ++seq, at_s, site: "s", time: 0, ...fields }) as unknown as FleetEvent;
const leg = (type: "leg_begun" | "leg_ended", at_s: number, robot: string, fields: object = {}) =>
  event(type, at_s, { robot, number: 1, booking: "tea", action: "collect", place: "F1/101", start: "F1/102", at: "F1/101", reason: null, ...fields });

const stop = (action: string, begins_s: number, done_s: number, fields: object = {}) => ({
  place: "F1/101", action, request: "tea", begins_s, done_s, slack_s: 40, partner: null, ...fields,
});
const robot = (name: string, fields: object = {}): FleetRobot =>
  ({ robot: name, works: true, connected: true, out_of_service: null, home: "F1/101", run: null, pose: null, battery: null, aboard: [], at_work: null, stops: [], ...fields }) as FleetRobot;

describe("rows of a fleet's chart", () => {
  it("have a bar from when a leg began until it ended, and of what goes on until now", () => {
    const events = [
      leg("leg_begun", 10, ONE),
      leg("leg_begun", 15, TWO, { booking: "mail" }),
      leg("leg_ended", 40, ONE, { outcome: "failed", reason: "nobody came" }),
    ];
    const [one, two] = chartRows([ONE, TWO], events, 60, null).lanes;
    expect(one?.name).toBe("ROBOT1");
    expect(one?.items).toMatchObject([{ start: 10, end: 40, look: "execution put-back" }]);
    expect(one?.items[0]?.title).toContain("collects tea at F1 101, from F1 102, failed: nobody came");
    expect(two?.items).toMatchObject([{ start: 15, end: 60, look: "execution" }]);
  });

  it("tell errands by who wanted them and whether the robot came there", () => {
    const author = { principal: "olga", role: "operator", address: null };
    const events = [
      event("errand_begun", 5, { robot: ONE, place: "F1/101", start: "F1/hall", author }),
      event("errand_ended", 9, { robot: ONE, place: "F1/101", came: true, reason: null, at: "F1/101" }),
      event("errand_begun", 20, { robot: ONE, place: "F1/hall", start: "F1/101", author: null }),
      event("errand_ended", 30, { robot: ONE, place: "F1/hall", came: false, reason: "it is lost", at: "F1/101" }),
    ];
    const [one] = chartRows([ONE], events, 60, null).lanes;
    expect(one?.items.map(({ start, end, look }) => [start, end, look])).toEqual([[5, 9, "errand"], [20, 30, "errand put-back"]]);
    expect(one?.items[0]?.title).toContain("sent by olga, came there");
    expect(one?.items[1]?.title).toContain("to make way, did not come there: it is lost");
  });

  it("show when a robot was out of service, and marks where plans changed and why", () => {
    const told = { author: null, finder: null, robot: ONE, told: "took robot1 out of service: a squeak" };
    const events = [
      event("fleet_told", 5, { ...told, in_service: false }),
      event("plan_changed", 6, { number: 1, reason: "robot1 has failed: a squeak", requests: ["tea"], robots: [ONE], said: { tea: "it is late" } }),
      event("fleet_told", 50, { ...told, told: "put robot1 back in service", in_service: true }),
    ];
    const [one, changes] = chartRows([ONE], events, 60, null).lanes;
    expect(one?.items).toMatchObject([{ start: 5, end: 50, look: "out" }]);
    expect(changes?.items.map(({ start, look }) => [start, look])).toEqual([[5, "deed"], [6, "change"], [50, "deed"]]);
    expect(changeInWords(events[1]!)).toEqual(["Robot1 has failed: a squeak.", "It touches ROBOT1, “tea”.", "Tea: it is late."]);
  });

  it("have what is planned from now on, once where it begins and ends at one place", () => {
    const at_work = { place: "F1/101", action: "visit", request: "tea" };
    const stops = [stop("visit", 30, 90), stop("visit", 90, 90), stop("collect", 50, 200, { place: "F1/103" })];
    const planned = chartRows([ONE], [], 60, [robot(ONE, { at_work, stops })]).lanes[0]!.items;
    expect(planned.map(({ start, end, look }) => [start, end, look])).toEqual([[60, 90, "execution planned"], [60, 200, "execution planned"]]);
    expect(new Set(planned.map((each) => each.seq)).size).toBe(2);
    expect(chartRows([ONE], [], 60, null).lanes[0]?.items).toEqual([]);
  });

  it("link what is given with what is taken, in the plan and in the past", () => {
    const robots = [
      robot(ONE, { stops: [stop("give", 100, 110, { partner: TWO })] }),
      robot(TWO, { stops: [stop("collect", 50, 60, { request: "mail" }), stop("take", 130, 140, { partner: ONE })] }),
    ];
    const events = [
      leg("leg_ended", 10, TWO, { action: "give", outcome: "done", booking: "old" }),
      leg("leg_ended", 20, ONE, { action: "take", outcome: "done", booking: "old" }),
      leg("leg_ended", 30, ONE, { action: "take", outcome: "failed", booking: "tea" }),
    ];
    expect(chartRows([ONE, TWO], events, 60, robots).transfers).toEqual([
      { request: "old", from: 1, to: 0, given_s: 10, taken_s: 20, planned: false },
      { request: "tea", from: 0, to: 1, given_s: 110, taken_s: 130, planned: true },
    ]);
  });
});

describe("the past of a fleet", () => {
  it("is told by its own events alone, as far as a moment", () => {
    expect(isOfFleet({ type: "site_opened" } as Event)).toBe(false);
    const events = [leg("leg_begun", 10, ONE), leg("leg_ended", 40, ONE)];
    expect(events.every(isOfFleet)).toBe(true);
    expect(eventsUntil(events, 39)).toEqual([events[0]]);
  });

  it("has each request as it was told of last", () => {
    const change = (at_s: number, status: string, robot_: string | null) =>
      event("request_changed", at_s, { request: "tea", what: { kind: "go_to_room" }, status, reason: null, robot: robot_, done_s: robot_ && 90 });
    const events = [change(1, "booked", ONE), change(5, "under_way", ONE), change(90, "done", null)];
    expect(requestsAfter(eventsUntil(events, 6))).toMatchObject([{ name: "tea", status: "under_way" }]);
    expect(requestsAfter(events)).toMatchObject([{ status: "done", expected: null }]);
    expect(requestsAfter([])).toEqual([]);
  });

  it("says nothing of when a request was expected, as that went on changing", () => {
    const booked = { request: "tea", what: { kind: "go_to_room" }, status: "booked", reason: null, robot: ONE, done_s: 90 };
    const replanned = event("plan_changed", 50, { number: 1, reason: "it is late", requests: ["tea"], robots: [TWO], said: {} });
    const [tea] = requestsAfter([event("request_changed", 1, booked), replanned]);
    expect(tea?.expected).toBe(null);
    expect(expectation(tea!, { now: 60, speed: 1 })).toBe("");
  });
});

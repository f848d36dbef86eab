// The robots of a fleet on its plan and in words, and how ways are closed.
import { describe, expect, it } from "vitest";
import { likelyEllipse } from "../src/building/likely_ellipse";
import { planOf } from "../src/building/plan";
import { seenRobots } from "../src/building/seen_robots";
import { type FleetEvent, legsAfter } from "../src/fleet/fleet_past";
import { fleetAtWork, fleetAtWorkThen, standingsOf } from "../src/fleet/fleet_robots";
import { closedInWords, hasInWords, isAtInWords, sureInWords } from "../src/fleet/fleet_words";
import { silence } from "../src/fleet/silence";
import { closedWay, sameWay } from "../src/fleet/picked";
import type { FleetRobot, FleetView, RequestView } from "../src/wire/types";
import { OFFICE } from "./office_scene";

const plan = planOf(OFFICE)!;
const ONE = "robot1-0a1b2c3d";

const robot = (fields: object = {}): FleetRobot =>
  ({ robot: ONE, works: true, connected: true, out_of_service: null, home: "F1/101", run: null, pose: null, battery: null, aboard: [], at_work: null, stops: [], ...fields }) as FleetRobot;
const fleet = (...robots: FleetRobot[]) => ({ robots }) as unknown as FleetView;
const pose = (x: number, age_s = 0) => ({ x, y: 0, z: 0, yaw: 0, age_s, covariance: null });
const at_work = { place: "F2/204", action: "collect", request: "tea", charges: false };

describe("robots of a fleet", () => {
  it("drive to the place of their leg, ask, or have nothing to do", () => {
    const [working] = fleetAtWork(fleet(robot({ at_work })), plan, new Map());
    expect(working).toMatchObject({ name: "ROBOT1", task: "working", goal: { name: "204", floor: "F2", x: 2, y: 1 } });
    expect(fleetAtWork(fleet(robot({ at_work })), plan, new Map([[ONE, "asking"]]))[0]?.task).toBe("asking");
    expect(fleetAtWork(fleet(robot({ connected: false })), plan, new Map())[0]).toMatchObject({ task: "idle", goal: null, lost: true });
  });

  it("move while their place changes from one reading to the next", () => {
    const first = standingsOf(fleet(robot({ pose: pose(1) })), new Map(), 0);
    expect(first.get(ONE)?.moving).toBe(false);
    expect(standingsOf(fleet(robot({ pose: pose(2) })), first, 0).get(ONE)?.moving).toBe(true);
    expect(standingsOf(fleet(robot()), first, 0).size).toBe(0);
  });

  it("are not seen where they are gone, or at work and silent; who rests stays where it is", () => {
    const seen = (fields: object) => standingsOf(fleet(robot(fields)), new Map(), 0).get(ONE)?.seen_s;
    expect(seen({ pose: pose(1, 60) })).toBeNull();
    expect(seen({ pose: pose(1, 60), at_work })).toBe(60);
    expect(seen({ pose: pose(1, 2), at_work })).toBeNull();
    expect(seen({ pose: pose(1, 2), connected: false })).toBe(2);
  });

  it("are not seen, and drive nowhere, while nothing comes of the whole fleet", () => {
    const about = { plan, past: false, atLeast: false };
    const moves = standingsOf(fleet(robot({ pose: pose(1), at_work })), new Map(), 0);
    for (const fields of [{ at_work }, {}]) {
      const silent = fleet(robot({ ...fields, pose: pose(2, 1) }));
      const [shown] = seenRobots(fleetAtWork(silent, plan, new Map()), [standingsOf(silent, moves, 4).get(ONE)!], about);
      expect(shown).toMatchObject({ unseen: "last seen 5 s ago", short: "last seen 5 s ago" });
      expect(shown?.activity).not.toBe("driving");
    }
  });

  it("are heard of while readings come, which may be late", () => {
    expect(silence(1_000, 1_500)).toBe(0);
    expect(silence(1_000, 3_900)).toBe(0);
    expect(silence(1_000, 18_700)).toBe(17);
  });

  it("say what they are at", () => {
    expect(isAtInWords(robot({ at_work }))).toBe("collects tea at F2 204");
    expect(isAtInWords(robot({ at_work: { place: "F1/101", action: null, request: null, charges: false } }))).toBe("goes to F1 101");
    expect(isAtInWords(robot({ at_work: { place: "F1/c", action: null, request: null, charges: true } }))).toBe("goes to F1 c to charge");
    expect(isAtInWords(robot({ out_of_service: "a squeak", works: false }))).toBe("is out of service: a squeak");
    expect(isAtInWords(robot({ works: false }))).toBe("does not work");
    expect(isAtInWords(robot())).toBe("has nothing to do");
  });

  it("were at what had begun and not ended at that moment", () => {
    const begun = { type: "leg_begun", robot: ONE, place: "F2/204", action: "collect", booking: "tea" };
    const sent = { type: "errand_begun", robot: "robot2", place: "F1/101", charges: false };
    const events = [begun, sent, { ...begun, type: "leg_ended" }] as unknown as FleetEvent[];
    const then = legsAfter(events.slice(0, 2));
    expect([...then]).toEqual([[ONE, at_work], ["robot2", { place: "F1/101", action: null, request: null, charges: false }]]);
    expect([...legsAfter(events).keys()]).toEqual(["robot2"]);
    const [working] = fleetAtWorkThen(fleet(robot({ connected: false })), plan, then);
    expect(working).toMatchObject({ task: "working", leaf: "tea", goal: { name: "204" }, lost: false });
    expect(fleetAtWorkThen(fleet(robot({ at_work })), plan, new Map())[0]).toMatchObject({ task: "idle", goal: null });
  });

  it("are as sure of their place as an ellipse is long, in which they are 95 times of 100", () => {
    expect(likelyEllipse([0.04, 0, 0.01])).toMatchObject({ degrees: 0 });
    expect(likelyEllipse([0.04, 0, 0.01]).rx).toBeCloseTo(0.2 * 2.4477, 3);
    expect(likelyEllipse([0.04, 0, 0.01]).ry).toBeCloseTo(0.1 * 2.4477, 3);
    expect(likelyEllipse([0.02, 0.01, 0.02]).degrees).toBeCloseTo(45);
    expect(likelyEllipse([0.01, 0, 0.04]).degrees).toBeCloseTo(90);
    expect(sureInWords([1e-9, 0, 1e-9])).toBe("1 cm");
    expect(sureInWords([1, 0, 1])).toBe("2.4 m");
  });
});

describe("closed ways", () => {
  it("are the same whichever of their places comes first, and say who found them", () => {
    expect(sameWay(["F1/a", "F1/b"], ["F1/b", "F1/a"])).toBe(true);
    expect(sameWay(["F1/a", "F1/b"], ["F1/b", "F1/c"])).toBe(false);
    const closed = [{ between: ["F1/101", "F1/hall"], finding: "door_closed" as const, by: ONE, until_s: 900 }];
    expect(closedWay(closed, ["F1/hall", "F1/101"])).toBe(closed[0]);
    expect(closedWay(closed, ["F1/hall", "F1/lift"])).toBeUndefined();
    expect(closedInWords(closed[0]!)).toBe("Door closed between F1 101 and F1 hall until 15:00, says ROBOT1");
  });
});

describe("what robots have", () => {
  const asked = (name: string, what: object) => ({ name, what }) as RequestView;

  it("is aboard where it is a thing, and people are shown the way", () => {
    const requests = [
      asked("guest", { kind: "escort", person: "Ms Lee" }),
      asked("mail--124d4c0c", { kind: "transport", what: "the mail" }),
    ];
    expect(hasInWords(robot({ aboard: ["guest"] }), requests)).toBe("It shows Ms Lee the way.");
    expect(hasInWords(robot({ aboard: ["mail--124d4c0c"] }), requests)).toBe("It has the mail aboard.");
    expect(hasInWords(robot({ aboard: ["tea"] }), requests)).toBe("It has tea aboard.");
  });
});

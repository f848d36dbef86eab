// The rows of a fleet's chart: what each robot did, is at and is to do, and why its plan changed.
import { howLong } from "../building/standing";
import { robotName } from "../question/fault_words";
import { placeInWords } from "../requests/places";
import { sentence } from "../run/run_words";
import { reasonInWords } from "../words/said";
import type { Lane, TimelineItem } from "../run/timeline/lanes";
import type { ErrandBegun, FleetRobot, LegBegun, LegEnded, PlannedStop } from "../wire/types";
import type { FleetEvent } from "./fleet_past";
import { authorInWords, doesInWords, wholeClock } from "./fleet_words";
import { t } from "../words/words";

/** What passes from one robot to another: rows, and when it is given and taken. */
export interface Transfer {
  readonly request: string;
  readonly from: number;
  readonly to: number;
  readonly given_s: number;
  readonly taken_s: number;
  readonly planned: boolean;
}

export interface ChartRows {
  readonly lanes: readonly Lane[];
  readonly transfers: readonly Transfer[];
}

interface Growing extends TimelineItem {
  parts: TimelineItem[];
}

/** Planned stops have no event: they are numbered below 0. */
const STOPS_OF_A_ROBOT = 10_000;

/** `robots` are those of the plan now, or null for a moment of the past, whose plan is not kept. */
export function chartRows(
  names: readonly string[],
  events: readonly FleetEvent[],
  now: number,
  robots: readonly FleetRobot[] | null,
): ChartRows {
  const rows = new Map(names.map((name) => [name, doneBy(name, events, now)]));
  for (const [index, robot] of (robots ?? []).entries()) {
    rows.get(robot.robot)?.push(...planned(robot, index, now));
  }
  const changes = events.flatMap(changeOf);
  return {
    lanes: [
      ...names.map((name): Lane => ({ kind: "steps", name: robotName(name), items: rows.get(name) ?? [] })),
      { kind: "people", name: t("Changes"), items: changes },
    ],
    transfers: [...made(names, events), ...toCome(names, robots ?? [])],
  };
}

/** What became of one robot's legs and errands, and when it was out of service. */
function doneBy(robot: string, events: readonly FleetEvent[], now: number): Growing[] {
  const items: Growing[] = [];
  let going: Growing | null = null;
  let out: Growing | null = null;
  const begin = (event: FleetEvent, word: string, title: string, look: string) => {
    const item = { seq: event.seq, start: event.at_s, end: Math.max(now, event.at_s), word, title, look, node: null, parts: [] };
    items.push(item);
    return item;
  };
  for (const event of events) {
    if (!("robot" in event) || event.robot !== robot) continue;
    switch (event.type) {
      case "leg_begun":
        going = begin(event, legWord(event), legTitle(event), "execution");
        break;
      case "errand_begun":
        going = begin(event, placeInWords(event.place), errandTitle(event), "errand");
        break;
      case "leg_ended":
        if (going !== null) endLeg(going, event);
        going = null;
        break;
      case "errand_ended":
        if (going !== null) {
          going.end = event.at_s;
          going.look = event.came ? "errand" : "errand put-back";
          going.title += event.came
            ? t(", came there")
            : t(", did not come there: {why}", { why: event.reason === null ? t("nobody knows why") : reasonInWords(event.reason) });
        }
        going = null;
        break;
      case "fleet_told":
        if (event.in_service === false) out = begin(event, t("out of service"), reasonInWords(event.told), "out");
        else if (event.in_service === true && out !== null) {
          out.end = event.at_s;
          out = null;
        }
        break;
    }
  }
  return items;
}

const OUTCOMES: Readonly<Record<string, readonly [string, string]>> = {
  done: ["execution done", t("done")],
  failed: ["execution put-back", t("failed")],
  withdrawn: ["execution put-back", t("broken off")],
  item_lost: ["execution put-back", t("it is lost")],
};

function endLeg(item: Growing, event: LegEnded): void {
  const [look, word] = OUTCOMES[event.outcome] ?? ["execution put-back", event.outcome];
  item.end = event.at_s;
  item.look = look;
  item.title += event.reason === null ? `, ${word}` : `, ${word}: ${reasonInWords(event.reason)}`;
}

function legWord({ booking, place }: LegBegun): string {
  return `${booking} ${placeInWords(place)}`;
}

function legTitle({ robot, action, booking, place, start }: LegBegun): string {
  return t("{robot} {action} at {place}, from {start}", {
    robot: robotName(robot),
    action: doesInWords(action, booking),
    place: placeInWords(place),
    start: placeInWords(start),
  });
}

function errandTitle({ robot, place, start, author }: ErrandBegun): string {
  const why = author === null ? t("to make way") : t("sent by {author}", { author: authorInWords(author) });
  return t("{robot} goes to {place}, from {start}, {why}", {
    robot: robotName(robot),
    place: placeInWords(place),
    start: placeInWords(start),
    why,
  });
}

/** What a robot is still to do; the leg that it is at ends when the plan says. */
function planned({ robot, stops, at_work }: FleetRobot, index: number, now: number): Growing[] {
  // What is done at one place has one stop at which it begins, and another at which it ends.
  const goals = stops.filter((stop, order) => !(order > 0 && isSame(stop, stops[order - 1])));
  return goals.map((stop, order) => {
    const isNow = order === 0 && at_work?.request === stop.request && at_work.place === stop.place;
    const start = isNow ? now : Math.max(stop.begins_s, now);
    const slack = stop.slack_s < 1e6 ? t(", may be {duration} late", { duration: howLong(stop.slack_s) }) : "";
    const partner = stop.partner === null ? "" : t(", with {partner}", { partner: robotName(stop.partner) });
    const does = doesInWords(stop.action, stop.request);
    return {
      seq: -(index * STOPS_OF_A_ROBOT + order + 1),
      start,
      end: Math.max(stop.done_s, start),
      word: `${stop.request} ${placeInWords(stop.place)}`,
      title: t("planned: {robot} {does} at {place} until {time}{slack}{partner}", {
        robot: robotName(robot),
        does,
        place: placeInWords(stop.place),
        time: wholeClock(stop.done_s),
        slack,
        partner,
      }),
      look: "execution planned",
      node: null,
      parts: [],
    };
  });
}

function isSame(a: PlannedStop, b: PlannedStop | undefined): boolean {
  return a.action === b?.action && a.request === b.request && a.place === b.place;
}

function changeOf(event: FleetEvent): TimelineItem[] {
  const mark = (title: string, look: string): TimelineItem[] => [
    { seq: event.seq, start: event.at_s, end: event.at_s, word: "", title, look, node: null, parts: [] },
  ];
  if (event.type === "plan_changed") return mark(reasonInWords(event.reason), "change");
  if (event.type === "fleet_told") return mark(reasonInWords(event.told), "deed");
  return [];
}

/** Whom a change of the plan touches, and what cannot be kept, a sentence each. */
export function changeInWords(event: FleetEvent): readonly string[] {
  switch (event.type) {
    case "plan_changed": {
      const touched = [...event.robots.map(robotName), ...event.requests.map((each) => `“${each}”`)];
      const whom = touched.length === 0 ? [] : [t("It touches {touched}.", { touched: touched.join(", ") })];
      return [sentence(reasonInWords(event.reason)), ...whom, ...Object.entries(event.said).map(([who, why]) => sentence(`${robotName(who)}: ${reasonInWords(why ?? "")}`))];
    }
    case "fleet_told": {
      const who = event.finder === null ? authorInWords(event.author) : robotName(event.finder);
      return [sentence(`${who}: ${reasonInWords(event.told)}`)];
    }
    default:
      return [];
  }
}

/** What was given by one robot and then taken over by another. */
function made(names: readonly string[], events: readonly FleetEvent[]): Transfer[] {
  const given = new Map<string, LegEnded>();
  const transfers: Transfer[] = [];
  for (const event of events) {
    if (event.type === "leg_ended" && event.outcome === "done" && event.action === "give") given.set(event.booking, event);
    if (event.type !== "leg_ended" || event.action !== "take" || event.outcome !== "done") continue;
    const before = given.get(event.booking);
    if (before === undefined) continue;
    const [from, to] = [names.indexOf(before.robot), names.indexOf(event.robot)];
    given.delete(event.booking);
    if (from >= 0 && to >= 0) {
      transfers.push({ request: event.booking, from, to, given_s: before.at_s, taken_s: event.at_s, planned: false });
    }
  }
  return transfers;
}

/** What the plan has one robot give and another take. */
function toCome(names: readonly string[], robots: readonly FleetRobot[]): Transfer[] {
  return robots.flatMap((giver) =>
    giver.stops.flatMap((stop): Transfer[] => {
      if (stop.action !== "give" || stop.partner === null) return [];
      const taker = robots.find(({ robot }) => robot === stop.partner);
      const taking = taker?.stops.find((each) => each.action === "take" && each.request === stop.request);
      if (taker === undefined || taking === undefined) return [];
      const [from, to] = [names.indexOf(giver.robot), names.indexOf(taker.robot)];
      return [{ request: stop.request, from, to, given_s: stop.done_s, taken_s: taking.begins_s, planned: true }];
    }),
  );
}

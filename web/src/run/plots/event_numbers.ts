// Every number that the events of a run carry, found wherever it stands in them.
import { plain, withoutRun } from "../../tree/words";
import type { Told } from "../../wire/told";
import { type Point, type Series, unitOf } from "./series";
import { t } from "../../words/words";

/** What says when and which, or is a definition and no measurement. */
const LEFT_OUT: ReadonlySet<string> = new Set(["seq", "time", "wall_time", "run", "lines", "tree", "scene", "script", "options", "seed", "speed"]);

/** The places of a point, where there are two or three of them. */
const AXES = ["x", "y", "z"];

interface Growing {
  id: string;
  name: string;
  unit: string;
  points: Point[];
}

export interface EventNumbers {
  /** Take the events that have come since; those before were taken already. */
  take(events: readonly Told[]): void;
  /** Each number that there is, by its name. */
  series(): readonly Series[];
}

export function createEventNumbers(): EventNumbers {
  const found = new Map<string, Growing>();
  let taken = 0;
  let several = false;

  const add = (event: Told, path: readonly string[], value: number) => {
    const field = path.at(-1) as string;
    const robot = several && "robot" in event && typeof event.robot === "string" ? event.robot : null;
    const id = [event.type, ...path, robot ?? ""].join("/");
    const point = { time: event.time, value, seq: event.seq };
    const known = found.get(id);
    if (known !== undefined) {
      known.points.push(point);
      return;
    }
    const [last, unit] = unitOf(AXES.includes(field) && path.length > 1 ? (path.at(-2) as string) : field);
    const words = [...path.slice(0, -1), field].map((word) => plain(unitOf(word)[0] || last));
    const of = robot === null ? "" : ` ${t("of {robot}", { robot: withoutRun(robot) })}`;
    found.set(id, { id, name: `${plain(event.type)}: ${words.join(", ")}${of}`, unit, points: [point] });
  };

  const walk = (event: Told, path: readonly string[], value: unknown): void => {
    if (typeof value === "number") add(event, path, value);
    else if (Array.isArray(value)) {
      const point = value.length <= AXES.length && value.every((each) => typeof each === "number");
      value.forEach((each: unknown, index) => walk(event, [...path, point ? (AXES[index] as string) : nameOf(each, index)], each));
    } else if (value !== null && typeof value === "object") {
      for (const [field, each] of Object.entries(value)) if (path.length > 0 || !LEFT_OUT.has(field)) walk(event, [...path, field], each);
    }
  };

  return {
    take(events) {
      for (; taken < events.length; taken++) {
        const event = events[taken] as Told;
        if (event.type === "run_started") several = event.robots.length > 1;
        walk(event, [], event);
      }
    },
    series: () => [...found.values()].sort((a, b) => a.name.localeCompare(b.name)),
  };
}

/** A part of a list by what it is called, so that it is the same one in another event. */
function nameOf(part: unknown, index: number): string {
  const named = part as { name?: unknown } | null;
  return typeof named === "object" && typeof named?.name === "string" ? named.name : String(index + 1);
}

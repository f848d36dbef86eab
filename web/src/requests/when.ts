// Moments of a building's clock, as people say them by their own.
import { t, tn } from "../words/words";
import { locale } from "../words/language";
import type { FleetView, SiteView } from "../wire/types";

/** A building's clock: what it shows (seconds), and how fast it goes beside people's. */
export interface SiteClock {
  now: number;
  speed: number | "max";
}

/** As it was last read; null until then. */
export function clockOf({ speed }: SiteView, fleet: FleetView | null): SiteClock | null {
  return fleet === null ? null : { now: fleet.now_s, speed };
}

const SOON_S = 90 * 60;

/** How long it is until a moment of it by people's own clock, seconds; by the building's where that just runs on. */
export function ownSeconds(moment: number, { now, speed }: SiteClock): number {
  return Math.max(0, moment - now) / (speed === "max" ? 1 : speed);
}

/** "in less than a minute", "in about 4 minutes" */
export function within(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  if (minutes < 1) return t("in less than a minute");
  return tn("in about {count} minute", "in about {count} minutes", { count: minutes });
}

/** When a moment of it (seconds) is: "in about 4 minutes, at 14:35"; without the time of day where the building's clock just runs on. */
export function when(moment: number, clock: SiteClock, today: Date): string {
  const left = ownSeconds(moment, clock);
  if (clock.speed === "max") return within(left);
  const then = new Date(today.getTime() + 1000 * left);
  const at = t("at {time}", { time: timeOf(then) });
  const there = onDay(then, at, today);
  return left < SOON_S ? `${within(left)}, ${there}` : there;
}

/** With the day, unless that is today: the weekday alone while there is one of it in between. */
function onDay(then: Date, at: string, today: Date): string {
  const days = daysBetween(today, then);
  if (days === 0) return at;
  if (days === 1) return t("tomorrow {at}", { at });
  return t("on {weekday} {at}", { weekday: (days < DAYS_OF_WEEK ? WEEKDAY : DATE).format(then), at });
}

/** Days of the calendar, whatever the hour, also where one of them has 23 hours. */
function daysBetween(one: Date, other: Date): number {
  const [first, last] = [one, other].map((each) => Date.UTC(each.getFullYear(), each.getMonth(), each.getDate()));
  return ((last ?? 0) - (first ?? 0)) / DAY_MS;
}

const DAY_MS = 86_400_000;
const DAYS_OF_WEEK = 7;
const WEEKDAY = new Intl.DateTimeFormat(locale, { weekday: "long" });
const DATE = new Intl.DateTimeFormat(locale, { weekday: "long", day: "numeric", month: "long" });

/** As on a clock of 24 hours. */
export function timeOf(moment: Date): string {
  return `${two(moment.getHours())}:${two(moment.getMinutes())}`;
}

const two = (number: number) => String(number).padStart(2, "0");

// Moments of a building's clock, as people say them by their own.
import { within } from "./request_words";
import { t } from "../words/words";
import { locale } from "../words/language";

/** A building's clock: what it shows (seconds), and how fast it goes beside people's. */
export interface SiteClock {
  now: number;
  speed: number | "max";
}

const SOON_S = 90 * 60;

/** When a moment of it (seconds) is: "in about 4 minutes, at 14:35"; without the time of day where the building's clock just runs on. */
export function when(moment: number, { now, speed }: SiteClock, today: Date): string {
  if (speed === "max") return within(moment - now);
  const left = Math.max(0, (moment - now) / speed);
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

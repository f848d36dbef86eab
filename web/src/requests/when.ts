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
  if (left < SOON_S) return `${within(left)}, ${at}`;
  return then.toDateString() === today.toDateString()
    ? at
    : t("on {weekday} {at}", { weekday: WEEKDAY.format(then), at });
}

const WEEKDAY = new Intl.DateTimeFormat(locale, { weekday: "long" });

/** As on a clock of 24 hours. */
export function timeOf(moment: Date): string {
  return `${two(moment.getHours())}:${two(moment.getMinutes())}`;
}

const two = (number: number) => String(number).padStart(2, "0");

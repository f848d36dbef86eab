// What somebody fills in, and the request that it is.
import { locale } from "../words/language";
import { t } from "../words/words";
import type { SiteClock } from "./when";

export type Kind = "transport" | "deliver_message" | "go_to_room" | "escort";

export interface Wish {
  kind: Kind;
  what: string;
  message: string;
  person: string;
  origin: string;
  destination: string;
  place: string;
  /** Minutes of the building's clock from now, as typed; empty is any time. */
  within: string;
}

export const NO_WISH: Wish = {
  kind: "transport",
  what: "",
  message: "",
  person: "",
  origin: "",
  destination: "",
  place: "",
  within: "",
};

const LAST_S = 1e8;
const MOST_MINUTES = 1_000_000;
const UNLIKE_CHARS = 8;
const LONGEST_NAME = 40;

/** What is missing at `now` of the building's clock, in a sentence; empty where nothing is. */
export function missing(wish: Wish, now: number): string {
  const most = mostMinutes(now);
  if (wish.within !== "" && !(Number(wish.within) > 0 && Number(wish.within) <= most)) {
    return t("Say in how many minutes it has to be done, with a number up to {most}, or leave that empty.", {
      most: new Intl.NumberFormat(locale).format(most),
    });
  }
  switch (wish.kind) {
    case "transport":
      if (wish.what.trim() === "") return t("Say what is to be brought.");
      return endsMissing(wish);
    case "deliver_message":
      if (wish.message.trim() === "") return t("Say what is to be told.");
      return wish.place === "" ? t("Say where.") : "";
    case "go_to_room":
      return wish.place === "" ? t("Say where.") : "";
    case "escort":
      if (wish.person.trim() === "") return t("Say who is to be shown the way.");
      return endsMissing(wish);
  }
}

/** No clock of a building goes on beyond `LAST_S`; a round number while that is far off. */
function mostMinutes(now: number): number {
  return Math.min(MOST_MINUTES, Math.floor((LAST_S - now) / 60));
}

/** Minutes are the building's, as in words: it says so where those are not people's own. */
export function withinWhat({ speed }: SiteClock): string {
  if (speed === 1) return t("Within minutes (optional)");
  if (speed === "max") return t("Within minutes of the building's clock (optional)");
  return t("Within minutes of the building's clock, which goes {speed} times as fast as yours (optional)", { speed: new Intl.NumberFormat(locale).format(speed) });
}

function endsMissing({ origin, destination }: Wish): string {
  if (origin === "" || destination === "") return t("Say from where, and to where.");
  return origin === destination ? t("It is there already: choose another place.") : "";
}

/** As robots say it, between quotation marks of their own: those in it are single ones. */
export function sayable(text: string): string {
  return text.replace(/[“”„‟«»"]/g, "'").trim();
}

/** What tells a request from others of the same words, and what robots do not say. */
export function newName(): string {
  return crypto.randomUUID().slice(0, UNLIKE_CHARS);
}

/** The request at `now` of the building's clock; `unlike` tells it from others of the same words. */
export function requestOf(wish: Wish, now: number, unlike: string): Record<string, unknown> {
  const latest = wish.within === "" ? {} : { latest_s: now + 60 * Number(wish.within) };
  const name = `${wordsOf(wish)}--${unlike}`;
  switch (wish.kind) {
    case "transport":
      return { kind: wish.kind, name, what: sayable(wish.what), origin: wish.origin, destination: wish.destination, ...latest };
    case "deliver_message":
      return { kind: wish.kind, name, message: sayable(wish.message), place: wish.place, ...latest };
    case "go_to_room":
      return { kind: wish.kind, name, place: wish.place, ...latest };
    case "escort":
      return { kind: wish.kind, name, person: sayable(wish.person), origin: wish.origin, destination: wish.destination, ...latest };
  }
}

/** What somebody brings who has only pointed at it: the console says so itself, in the words of its language. */
export const THIS = "this";

/** Whether a thing has no name but that. */
export function isPointedAt(what: string): boolean {
  return /^(this|that|it|these|those|them)$/i.test(what.trim());
}

function wordsOf({ kind, what }: Wish): string {
  const words = kind === "transport" && !isPointedAt(what) ? what.replace(/[^A-Za-z0-9]+/g, "_").replace(/^[^A-Za-z]+|_+$/g, "") : "";
  return words.slice(0, LONGEST_NAME) || { transport: "thing", deliver_message: "message", go_to_room: "visit", escort: "escort" }[kind];
}

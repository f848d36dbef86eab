// How what fills the sentences of a fleet's reasons is said: robots and places as people call them, times as clocks show them.
import { howLong } from "../building/standing";
import { robotName } from "../question/fault_words";
import { placeInWords } from "../requests/places";
import { reasonInWords, type FieldWords } from "../words/said";
import type { Words } from "../words/words";
import { wholeClock } from "./fleet_words";
import { REASONS } from "./reasons";

const time = (seconds: string) => wholeClock(Number(seconds));

export const REASON_FIELDS: FieldWords = {
  robot: robotName,
  taker: robotName,
  place: placeInWords,
  goal: placeInWords,
  time,
  until: time,
  from: time,
  later: time,
  lasts: (seconds) => howLong(Math.ceil(Number(seconds))),
  list: (each) => each.split(", ").map(reasonInWords).join(", "),
};

/** The sentences in English: as they are, but for what a clock shows. */
export const IN_ENGLISH: Words = Object.fromEntries(
  REASONS.map((each) => [each, each.replaceAll(/\{(time|until|lasts|later)\} s\b/g, "{$1}")]),
);

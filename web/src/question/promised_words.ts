// What somebody has promised to a robot, and what it then watches for, by what it has asked for.
import type { Question } from "../state/questions";
import type { Help } from "../wire/types";
import { t } from "../words/words";
import { spoken } from "./fault_words";

type About = Pick<Question, "issue" | "detection" | "object" | "name">;

const PROMISES: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => t("would place the {part}", { part }),
  put_back: (part) => t("would put the {part} back on the table", { part }),
  hand_over: (part) => t("would hand over the {part}", { part }),
  clear_way: () => t("would clear the way"),
  clear_view: () => t("would clear the view of the head camera"),
  tell_place: () => t("know where it is"),
  put_in: () => t("would put something into its basket"),
  take_out: () => t("would take something out of its basket"),
  charge: () => t("would plug it in"),
  send_person: () => t("would tell who is to follow it to come"),
};

const EXPECTED: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => t("The robot watches for the {part} at its place.", { part }),
  put_back: (part) => t("The robot watches for the {part} on the table, within its reach.", { part }),
  hand_over: (part) => t("The robot watches for the {part} between its fingers, and then grips it.", { part }),
  clear_way: () => t("The robot watches until nothing is in the way of its arm."),
  clear_view: () => t("The robot watches until its head camera sees the table."),
  tell_place: () => t("The robot looks whether what its laser sees agrees with that."),
  put_in: () => t("The robot waits until it feels that in its basket."),
  take_out: () => t("The robot waits until it feels that its basket is lighter."),
  charge: () => t("The robot waits until it feels current."),
  send_person: () => t("The robot waits until it sees them beside it."),
};

/** What clears the way of a base is not always something in it. */
const CLEARS: Readonly<Record<string, { promise: string; expected: string }>> = {
  door_closed: {
    promise: t("would open the door"),
    expected: t("The robot watches until it sees the door open."),
  },
  elevator_help: {
    promise: t("would call the elevator and press its button"),
    expected: t("The robot watches until it sees the elevator open."),
  },
  wrong_floor: {
    promise: t("would press the button for its floor"),
    expected: t("The robot waits until it is at its floor."),
  },
};

/** What they have promised, after "said they". */
export function promised(question: About, help: Help): string {
  return clears(question, help)?.promise ?? PROMISES[help](partOf(question));
}

/** A base sees with its laser, and has no arm. */
export function watchedFor(question: About, help: Help): string {
  const special = clears(question, help);
  if (special !== undefined) return special.expected;
  if (help === "clear_way" && question.detection?.camera === "laser") return t("The robot watches until its way is free.");
  return EXPECTED[help](partOf(question));
}

function clears({ issue }: About, help: Help) {
  return help === "clear_way" ? CLEARS[issue] : undefined;
}

function partOf({ object, name }: About): string {
  return spoken(object ?? name);
}

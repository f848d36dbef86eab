// What is asked one after the other at a robot's touch screen, and the wish that comes of it.
import { placeInWords } from "../requests/places";
import { isPointedAt, type Kind, NO_WISH, sayable, THIS, type Wish } from "../requests/wish";
import { t } from "../words/words";

export type Step = "what" | "message" | "origin" | "destination" | "place";

export interface Asked {
  kind: Kind;
  /** One for each step so far. */
  answers: readonly string[];
}

const STEPS: Readonly<Record<Kind, readonly Step[]>> = {
  transport: ["what", "origin", "destination"],
  deliver_message: ["message", "place"],
  go_to_room: ["place"],
  escort: ["destination"],
};

/** Whom robots call somebody who has not said their name. */
export const WHOEVER_ASKED = t("whoever asked");

/** Whether it is answered in words that are typed. */
export function isText(step: Step): step is "what" | "message" {
  return step === "what" || step === "message";
}

/** What is to be asked next; null where all is known. */
export function nextStep({ kind, answers }: Asked): Step | null {
  return STEPS[kind][answers.length] ?? null;
}

/** The words that were typed so far; null where there are none. */
export function textOf({ kind, answers }: Asked): string | null {
  const [first] = STEPS[kind];
  return first !== undefined && isText(first) && answers[0] !== THIS ? (answers[0] ?? null) : null;
}

/** The wish, once all is known; `here` is where the robot stands. */
export function wishOf({ kind, answers }: Asked, here: string | null): Wish {
  const known = Object.fromEntries(STEPS[kind].map((step, at) => [step, isText(step) ? sayable(answers[at] ?? "") : (answers[at] ?? "")]));
  const more = kind === "escort" ? { person: WHOEVER_ASKED, origin: here ?? "" } : {};
  return { ...NO_WISH, kind, ...more, ...known };
}

/** The sentence that asks whether a wish is right. */
export function readBackOf(wish: Wish): string {
  return t("I am to {wish}. Is that right?", { wish: deedOf(wish) });
}

function deedOf({ kind, what, message, person, origin, destination, place }: Wish): string {
  const way = t("from {origin} to {destination}", { origin: placeInWords(origin), destination: placeInWords(destination) });
  switch (kind) {
    case "transport":
      return isPointedAt(what) ? t("bring this {way}", { way }) : t("bring {what} {way}", { what, way });
    case "escort":
      return person === WHOEVER_ASKED
        ? t("show you the way {way}", { way })
        : t("show {person} the way {way}", { person, way });
    case "deliver_message":
      return t("tell {place} that “{message}”", { place: placeInWords(place), message });
    case "go_to_room":
      return t("come to {place}", { place: placeInWords(place) });
  }
}

// What the camera sees that is to see promised help; loaded after the card is there.
import { later } from "../app/later";
import type { Question } from "../state/questions";
import type { Help } from "../wire/types";

export const HelpCamera = later(() => import("./live_help").then((module) => module.LiveHelp));

const CAMERAS: Partial<Record<Help, string>> = {
  place: "head",
  put_back: "head",
  clear_way: "head",
  clear_view: "head",
  hand_over: "forearm",
};

/** Of a base, which sees with its laser and feels, there is no picture. */
const NO_PICTURE: ReadonlySet<string | undefined> = new Set(["laser", "basket", "gauge", "tracker", "listening"]);

/** The camera that is to see the help that is awaited; null where none is. */
export function seenBy({ help, detection }: Pick<Question, "help" | "detection">): string | null {
  if (help === null || NO_PICTURE.has(detection?.camera)) return null;
  return CAMERAS[help.help] ?? null;
}

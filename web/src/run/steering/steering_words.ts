// The words for steering a run.
import { plain } from "../../tree/words";
import type { AutonomyLevel, SteeringAct, WaitView } from "../../wire/types";

export const ACT_WORDS: Readonly<Record<SteeringAct, string>> = {
  go_on: "Go on",
  set_breakpoint: "Set breakpoint",
  remove_breakpoint: "Remove breakpoint",
  do_next: "Do it next",
  not_next: "Not next after all",
  try_again: "Try it again",
  leave_out: "Leave it out",
  done_by_hand: "Done by hand",
};

export const LEVEL_WORDS: Readonly<Record<AutonomyLevel, string>> = {
  off: "asks before each leaf",
  low: "asks before what has failed or is gone",
  high: "asks only before leaves that say so",
  full: "does everything by itself",
};

type Held = Pick<WaitView, "name" | "breakpoint" | "by" | "reason" | "level">;

/** Why nobody begins a leaf that could be begun, after who waits. */
export function whyItWaits({ name, breakpoint, by, reason, level }: Held): string {
  const because = reason === "" ? "" : ` (${reason})`;
  const why = breakpoint === null ? `with autonomy ${level} it asks first` : `breakpoint set by ${by ?? "somebody"}${because}`;
  return `waits before ${plain(name)}: ${why}.`;
}

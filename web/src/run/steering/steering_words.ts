// The words for steering a run.
import { plain } from "../../tree/words";
import type { AutonomyLevel, SteeringAct, WaitView } from "../../wire/types";
import { t } from "../../words/words";

export const ACT_WORDS: Readonly<Record<SteeringAct, string>> = {
  go_on: t("Go on"),
  set_breakpoint: t("Set breakpoint"),
  remove_breakpoint: t("Remove breakpoint"),
  do_next: t("Do it next"),
  not_next: t("Not next after all"),
  try_again: t("Try it again"),
  leave_out: t("Leave it out"),
  done_by_hand: t("Done by hand"),
};

export const LEVEL_WORDS: Readonly<Record<AutonomyLevel, string>> = {
  off: t("asks before each leaf"),
  low: t("asks before what has failed or is gone"),
  high: t("asks only before leaves that say so"),
  full: t("does everything by itself"),
};

type Held = Pick<WaitView, "name" | "breakpoint" | "by" | "reason" | "level">;

/** Why nobody begins a leaf that could be begun, after who waits. */
export function whyItWaits({ name, breakpoint, by, reason, level }: Held): string {
  const because = reason === "" ? "" : ` (${reason})`;
  const why =
    breakpoint === null
      ? t("with autonomy {level} it asks first", { level })
      : t("breakpoint set by {by}{because}", { by: by ?? t("somebody"), because });
  return t("waits before {name}: {why}.", { name: plain(name), why });
}

// How the console says what an issue was, and how it ended.
import { withMoment } from "../run/moment_in_address";
import type { IssueSummary } from "../wire/types";
import { t } from "../words/words";

type Outcome = NonNullable<IssueSummary["outcome"]>;

export const OUTCOME_WORDS: Readonly<Record<Outcome, string>> = {
  resolved: t("Resolved"),
  withdrawn: t("Withdrawn by the robot"),
  gave_up: t("Given up"),
  left_out: t("Left out"),
  aborted: t("Lapsed"),
};

/** How an issue ended: the word of its dialogue, or that there is none yet. */
export function outcomeOf({ outcome, dialogue }: IssueSummary): string {
  if (outcome !== null) return OUTCOME_WORDS[outcome];
  return dialogue === null ? t("Nobody was asked") : t("Being asked about");
}

/** Where the console shows an issue: its run at the moment just after it was raised. */
export function momentOf({ run, time }: IssueSummary): string {
  return withMoment(`/runs/${run}`, time);
}

// How the console says what an issue was, and how it ended.
import { withMoment } from "../run/moment_in_address";
import type { IssueSummary } from "../wire/types";

type Outcome = NonNullable<IssueSummary["outcome"]>;

export const OUTCOME_WORDS: Readonly<Record<Outcome, string>> = {
  resolved: "Resolved",
  withdrawn: "Withdrawn by the robot",
  gave_up: "Given up",
  left_out: "Left out",
  aborted: "The run ended",
};

/** How an issue ended: the word of its dialogue, or that there is none yet. */
export function outcomeOf({ outcome, dialogue }: IssueSummary): string {
  if (outcome !== null) return OUTCOME_WORDS[outcome];
  return dialogue === null ? "Nobody was asked" : "Being asked about";
}

/** Where the console shows an issue: its run at the moment just after it was raised. */
export function momentOf({ run, time }: IssueSummary): string {
  return withMoment(`/runs/${run}`, time);
}

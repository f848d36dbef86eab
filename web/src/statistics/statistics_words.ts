// How the console tells figures over many runs: each with what it counts, and none where there is nothing to count.
import { OUTCOME_WORDS } from "../issues/issue_words";
import type { AnswerTimes, OutcomeCounts, RunCounts, WorkStatistics } from "../wire/types";
import { decimal, t, tn } from "../words/words";
import { locale } from "../words/language";

const OUTCOMES: readonly (readonly [keyof OutcomeCounts, string])[] = [
  ["resolved", OUTCOME_WORDS.resolved],
  ["withdrawn", OUTCOME_WORDS.withdrawn],
  ["gave_up", OUTCOME_WORDS.gave_up],
  ["left_out", OUTCOME_WORDS.left_out],
  ["aborted", OUTCOME_WORDS.aborted],
  ["open", t("Being asked about")],
  ["unasked", t("Nobody was asked")],
];

/** A figure, and what it is of. */
export interface Figure {
  readonly value: string;
  readonly of: string;
}

export function faultsOf(count: number): string {
  return tn("{count} fault", "{count} faults", { count });
}

/** How often it went wrong; `picks` may be of more than what went wrong. */
export function rateOf({ faults, picks, faults_per_1000_picks: rate }: WorkStatistics): Figure {
  if (rate === null) return { value: t("no picks"), of: faultsOf(faults) };
  const value = rate.toLocaleString(locale, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
  return { value, of: t("{faults} in {picks}", { faults: faultsOf(faults), picks: tn("{count} pick", "{count} picks", { count: picks }) }) };
}

/** How long people took to answer. */
export function answersOf({ count, median_s: median, p95_s: p95 }: AnswerTimes): Figure {
  if (median === null || p95 === null) return { value: t("no answers"), of: t("of people") };
  return {
    value: lasted(median),
    of: t("95 % within {duration}, {answers}", {
      duration: lasted(p95),
      answers: tn("{count} answer", "{count} answers", { count }),
    }),
  };
}

/** How faults ended, the outcomes that there were alone. */
export function outcomesOf(outcomes: OutcomeCounts): string {
  const told = OUTCOMES.filter(([name]) => outcomes[name] > 0).map(
    ([name, word]) => `${outcomes[name].toLocaleString(locale)} ${word.toLowerCase()}`,
  );
  return told.length === 0 ? t("no faults") : told.join(", ");
}

const STATES = {
  running: t("running"),
  paused: t("paused"),
  finished: t("finished"),
  failed: t("failed"),
  aborted: t("aborted"),
} as const;

/** How the runs stand. */
export function runsOf(runs: RunCounts): Figure {
  if (runs.total === 0) return { value: t("no runs"), of: "" };
  const states = (["running", "paused", "finished", "failed", "aborted"] as const).filter((state) => runs[state] > 0);
  return {
    value: runs.total.toLocaleString(locale),
    of: states.map((state) => `${runs[state].toLocaleString(locale)} ${STATES[state]}`).join(", "),
  };
}

/** A duration as people say it. */
export function lasted(seconds: number): string {
  if (seconds < 59.95) return `${decimal(seconds, 1)} s`;
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return hours > 0
    ? `${hours} h ${minutes} min`
    : `${minutes} min ${whole % 60} s`;
}

// How the console says what state a run is in, and when something was.
import { plain } from "../tree/words";
import type { RunStatus, RunSummary } from "../wire/types";
import { decimal, t } from "../words/words";
import { locale } from "../words/language";
import { said } from "../words/said";

export const STATUS_WORDS: Readonly<Record<RunStatus, string>> = {
  running: t("Running"),
  paused: t("Paused"),
  finished: t("Finished"),
  failed: t("Failed"),
  aborted: t("Aborted"),
  unreadable: t("Unreadable"),
};

/** Beside the word and the colour, a sign for those who do not tell colours. */
export const STATUS_SIGNS: Readonly<Record<RunStatus, string>> = {
  running: "▶",
  paused: "‖",
  finished: "✓",
  failed: "✕",
  aborted: "■",
  unreadable: "?",
};

/** What came of a run, in a sentence; empty while it goes on. */
export function outcome({ result }: RunSummary): string {
  if (result === null) return "";
  const reason = said(result.reason);
  return reason.charAt(0).toUpperCase() + reason.slice(1);
}

/** A site as people call it: by its scene, and the beginning of its id. */
export function siteName({ id, scene }: { id: string; scene: string }): string {
  return `${plain(scene)} (${id.slice(0, 8)})`;
}

const UNITS: readonly (readonly [Intl.RelativeTimeFormatUnit, number])[] = [
  ["day", 86_400],
  ["hour", 3_600],
  ["minute", 60],
];

const RELATIVE = new Intl.RelativeTimeFormat(locale, { numeric: "auto" });
const MOMENT = new Intl.DateTimeFormat(locale, { dateStyle: "medium", timeStyle: "short" });

/** "5 minutes ago"; both times in ms since 1970. */
export function ago(then: number, now: number): string {
  const seconds = (now - then) / 1000;
  for (const [unit, length] of UNITS) {
    if (seconds >= length) return RELATIVE.format(-Math.floor(seconds / length), unit);
  }
  return t("just now");
}

/** "21 Nov 2026, 14:03" */
export function moment(then: number): string {
  return MOMENT.format(then);
}

/** A time of a clock as people read it: 7.4 s, 2:07.4, 1:02:07.4. */
export function clock(time: number): string {
  const tenths = Math.round(time * 10);
  if (tenths < 600) return `${decimal(tenths / 10, 1)} s`;
  const seconds = decimal((tenths % 600) / 10, 1).padStart(4, "0");
  const [hours, minutes] = [Math.floor(tenths / 36_000), Math.floor(tenths / 600) % 60];
  return hours === 0 ? `${minutes}:${seconds}` : `${hours}:${String(minutes).padStart(2, "0")}:${seconds}`;
}

/** What the service says, as a sentence. */
export function sentence(message: string): string {
  const text = message.charAt(0).toUpperCase() + message.slice(1);
  return /[.!?]$/.test(text) ? text : `${text}.`;
}

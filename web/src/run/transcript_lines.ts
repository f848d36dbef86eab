// The lines of a run's transcript, as the service words them.
import { plain } from "../tree/words";
import type { Told } from "../wire/told";
import type { TranscriptLine } from "../wire/types";
import { learn, said } from "../words/said";
import { t } from "../words/words";

export interface Line extends TranscriptLine {
  /** The event that it tells. */
  readonly seq: number;
  readonly time: number;
}

/** The lines of an event; none for those that others already tell. */
export function linesOf(event: Told): Line[] {
  const { seq, time, lines } = event;
  return lines.map((line) => ({
    ...line,
    seq,
    time,
    // Only a behavior has a name of the task file; robots and people are called as they are.
    speaker: line.tone === "step" ? plain(line.speaker) : said(line.speaker),
    text: inWords(plain(line.text), event),
  }));
}

/** A line in the reader's language: what a robot asks is followed by whom, and whether it has asked before. */
function inWords(text: string, event: Told): string {
  if (event.type !== "prompt" || !text.startsWith(event.text)) return said(text);
  learn(event.wordings);
  const again = event.version > 1 ? ` ${t("(asked again)")}` : "";
  const to = event.to === null ? "" : ` ${t("(to {helper})", { helper: event.to })}`;
  return `${said(event.text)}${again}${to}`;
}

/** The text of an event's last line, which says what it comes to. */
export function lastOf(event: Told): string {
  return linesOf(event).at(-1)?.text ?? "";
}

/** Put a line behind those that there are, joined to the last one if both are of one thread. */
export function joined(lines: Line[], line: Line): void {
  const last = lines.at(-1);
  if (last === undefined || line.thread === null || last.thread !== line.thread) lines.push(line);
  else lines[lines.length - 1] = { ...last, text: `${last.text} · ${line.text}` };
}

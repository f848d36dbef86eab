// The transcript: everything that was said and done, with the moment that is shown marked in it.
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { Told } from "../wire/told";
import type { Tone } from "../wire/types";
import { clock } from "./run_words";
import { joined, type Line, linesOf } from "./transcript_lines";
import { t } from "../words/words";
import { Quoted, Told as ToldText } from "../words/told";
import "./transcript.css";

/** So many lines are drawn together, and skipped together while nothing of them is in sight. */
const PORTION = 40;

/** What somebody says word for word. */
const QUOTED: readonly Tone[] = ["said", "asked", "answered"];

interface TranscriptProps {
  events: readonly Told[];
  /** Counts up with `events`, which is the same array all along. */
  version: number;
  /** The last event that has happened at the moment shown; null follows the newest. */
  until: number | null;
  onChoose: (line: Line) => void;
}

export function Transcript({ events, version, until, onChoose }: TranscriptProps) {
  const portions = usePortions(events, version);
  const list = useRef<HTMLDivElement>(null);
  const last = portions.at(-1)?.at(-1)?.seq ?? 0;
  const current = until ?? last;
  useFollowing(list, current, until === null);
  return (
    <div class="transcript" ref={list} role="log" aria-label={t("Transcript")} tabIndex={0}>
      {portions.map((lines, index) => {
        const first = lines[0]?.seq ?? 0;
        const end = portions[index + 1]?.[0]?.seq ?? Infinity;
        const within = current >= first && current < end;
        return (
          <Portion
            key={index}
            lines={lines}
            until={within ? current : current < first ? -1 : Infinity}
            marked={until !== null && within}
            onChoose={onChoose}
          />
        );
      })}
    </div>
  );
}

/** The lines so far in portions; portions that are full stay the same arrays. */
function usePortions(events: readonly Told[], version: number): readonly (readonly Line[])[] {
  const kept = useRef<{ lines: Line[]; taken: number; portions: Line[][] }>({ lines: [], taken: 0, portions: [] });
  return useMemo(() => {
    const { lines, portions } = kept.current;
    // The last line may have grown, and the last portion with it.
    const changedFrom = Math.floor(Math.max(lines.length - 1, 0) / PORTION);
    for (; kept.current.taken < events.length; kept.current.taken++) {
      for (const line of linesOf(events[kept.current.taken] as Told)) joined(lines, line);
    }
    for (let index = changedFrom; index * PORTION < lines.length; index++) {
      portions[index] = lines.slice(index * PORTION, (index + 1) * PORTION);
    }
    return [...portions];
  }, [events, version]);
}

interface PortionProps {
  lines: readonly Line[];
  until: number;
  marked: boolean;
  onChoose: (line: Line) => void;
}

/** Drawn anew only when something in it has changed: a long transcript has hundreds of these. */
function Portion({ lines, until, marked, onChoose }: PortionProps) {
  return useMemo(() => {
    const current = marked ? lines.findLast((line) => line.seq <= until) : undefined;
    return (
      <ol class="transcript-portion">
        {lines.map((line, index) => (
          <li
            key={`${line.seq} ${index}`}
            class={`line ${line.tone} ${line.seq > until ? "later" : ""}`}
            aria-current={line === current ? "time" : undefined}
          >
            <button
              type="button"
              class="bare"
              onClick={() => onChoose(line)}
              aria-label={t("Go to {time}", { time: clock(line.time) })}
            >
              {clock(line.time)}
            </button>
            <p>
              {line.speaker !== "" && <b>{line.speaker} </b>}
              <Text of={line} />
            </p>
          </li>
        ))}
      </ol>
    );
  }, [lines, until, marked, onChoose]);
}

/** A line may be joined of several texts. */
function Text({ of: { text, tone } }: { of: Line }) {
  return QUOTED.includes(tone) ? <Quoted text={text} /> : <ToldText text={text} />;
}

const NEAR_THE_END_PX = 80;

/** Keep the newest line in sight while somebody is at the end; bring a chosen moment into sight. */
function useFollowing(list: { current: HTMLElement | null }, current: number, newest: boolean): void {
  const atEnd = useRef(true);
  useEffect(() => {
    const scrolled = list.current;
    if (scrolled === null) return;
    const look = () => {
      atEnd.current = scrolled.scrollHeight - scrolled.scrollTop - scrolled.clientHeight < NEAR_THE_END_PX;
    };
    scrolled.addEventListener("scroll", look, { passive: true });
    return () => scrolled.removeEventListener("scroll", look);
  }, []);
  useEffect(() => {
    if (newest) atEnd.current = true;
  }, [newest]);
  useEffect(() => {
    const scrolled = list.current;
    if (scrolled === null) return;
    if (newest) {
      if (atEnd.current) scrolled.scrollTop = scrolled.scrollHeight;
      return;
    }
    const line = scrolled.querySelector<HTMLElement>("[aria-current]");
    return line === null ? undefined : bringToMiddle(scrolled, line);
  }, [current, newest]);
}

const MOST_FRAMES = 10;

/** Scroll until a line is in the middle; returns how to stop. */
function bringToMiddle(scrolled: HTMLElement, line: HTMLElement): () => void {
  let request = 0;
  let frames = 0;
  const step = () => {
    const off = line.getBoundingClientRect().top - scrolled.getBoundingClientRect().top;
    scrolled.scrollTop += off - scrolled.clientHeight / 2;
    // How high portions are that were not drawn yet is a guess: once they are, it is farther or nearer.
    if (++frames < MOST_FRAMES) request = requestAnimationFrame(step);
  };
  step();
  return () => cancelAnimationFrame(request);
}

// The seconds before a fault: played, or scrubbed by hand.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Question } from "../state/questions";
import { picturePath } from "../wire/rest";
import type { ClipPicture } from "../wire/types";
import { decimal, t } from "../words/words";

interface Props {
  question: Question;
  /** Null is the fault itself. */
  frame: number | null;
  onFrame(frame: number | null): void;
}

export function ClipControls({ question: { clip, dialogue }, frame, onFrame }: Props) {
  const [playing, setPlaying] = useState(false);
  const position = frame ?? clip.length;
  useEffect(() => preload(clip), [dialogue, clip.length]);
  const latest = useRef(onFrame);
  latest.current = onFrame;
  useEffect(() => {
    if (!playing) return;
    if (position >= clip.length) {
      setPlaying(false);
      return;
    }
    const next = position + 1;
    const timer = window.setTimeout(
      () => latest.current(next >= clip.length ? null : next),
      pauseMs(clip, position),
    );
    return () => window.clearTimeout(timer);
  }, [playing, position, clip]);
  const play = () => {
    if (!playing && position >= clip.length) onFrame(0);
    setPlaying(!playing);
  };
  const scrub = (event: Event) => {
    const value = Number((event.currentTarget as HTMLInputElement).value);
    setPlaying(false);
    onFrame(value >= clip.length ? null : value);
  };
  const when = momentInWords(clip, position);
  return (
    <div class="clip">
      <button type="button" class="button clip-play" onClick={play} aria-label={playing ? t("Pause the clip") : t("Play the seconds before")}>
        <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
          <path d={playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 1.5 14 8 3 14.5z"} fill="currentColor" />
        </svg>
      </button>
      <input
        type="range"
        min="0"
        max={clip.length}
        value={position}
        onInput={scrub}
        aria-label={t("Moment before the fault")}
        aria-valuetext={when}
      />
      <output class="small quiet" aria-hidden="true">
        {shortMoment(clip, position)}
      </output>
    </div>
  );
}

/** How long a picture is shown; the last one leads on to the fault. */
export function pauseMs(clip: readonly ClipPicture[], position: number): number {
  const here = clip[position];
  const next = clip[position + 1];
  return here === undefined || next === undefined ? 200 : Math.min(1000, (next.time - here.time) * 1000);
}

function secondsBefore(clip: readonly ClipPicture[], position: number): number {
  const here = clip[position];
  const end = clip.at(-1);
  return here === undefined || end === undefined ? 0 : end.time - here.time + 0.2;
}

function momentInWords(clip: readonly ClipPicture[], position: number): string {
  const before = secondsBefore(clip, position);
  return before === 0 ? t("the moment of the fault") : t("{before} seconds before the fault", { before: decimal(before, 1) });
}

function shortMoment(clip: readonly ClipPicture[], position: number): string {
  const before = secondsBefore(clip, position);
  return before === 0 ? t("fault") : `−${decimal(before, 1)} s`;
}

function preload(clip: readonly ClipPicture[]): void {
  for (const { picture } of clip) new Image().src = picturePath(picture);
}

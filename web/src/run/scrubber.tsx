// The bar that moves the shown moment: a slider over the run's time, play, and the way back.
import { useState } from "preact/hooks";
import { connection } from "../state/service";
import { withMoment } from "./moment_in_address";
import { clock } from "./run_words";
import { type Moment, SPEEDS } from "./moment";
import { decimal, parts, t } from "../words/words";
import "./scrubber.css";

const STEP_S = 0.1;

interface ScrubberProps {
  /** Whose moment it is. */
  of?: string;
  moment: Moment;
  /** Whether the run goes on. */
  going: boolean;
  /** Go to the event before or after the moment. */
  onStep: (direction: -1 | 1) => void;
  faults?: FaultSteps;
}

/** Going from fault to fault; null where there is none that way. */
interface FaultSteps {
  before: (() => void) | null;
  after: (() => void) | null;
}

export function Scrubber({ of = t("the run"), moment, going, onStep, faults }: ScrubberProps) {
  const time = moment.time.value;
  const end = moment.end.value;
  const newest = moment.newest.value;
  const playing = moment.playing.value;
  // Whole steps up to the end, so that the slider's last step is not before it.
  const last = Math.max(Math.ceil(end / STEP_S), 1) * STEP_S;
  return (
    <section class={`scrubber ${newest ? "newest" : "past"}`} aria-label={t("Moment")}>
      <div class="scrubber-buttons">
        {faults && <FaultButton name={t("Previous fault")} keys="Shift+ArrowLeft" d={FAULT_BEFORE} go={faults.before} />}
        <button type="button" class="bare icon-button" aria-label={t("One event back")} onClick={() => onStep(-1)}>
          <Icon d="M14 4l-8 6 8 6zM4 4v12" />
        </button>
        <button
          type="button"
          class="bare icon-button"
          aria-label={playing ? t("Stop playing") : t("Play")}
          onClick={() => (playing ? moment.pause() : moment.play())}
        >
          <Icon d={playing ? "M6 4v12M14 4v12" : "M6 3l11 7-11 7z"} />
        </button>
        <button type="button" class="bare icon-button" aria-label={t("One event on")} disabled={newest} onClick={() => onStep(1)}>
          <Icon d="M6 4l8 6-8 6zM16 4v12" />
        </button>
        {faults && <FaultButton name={t("Next fault")} keys="Shift+ArrowRight" d={FAULT_AFTER} go={faults.after} />}
      </div>
      <input
        type="range"
        aria-label={t("Moment of {of}", { of })}
        aria-valuetext={t("{time} of {end} seconds", { time: decimal(time, 1), end: decimal(end, 1) })}
        min={0}
        max={last}
        step={STEP_S}
        value={newest ? last : time}
        onInput={(event) => moment.goTo(Number(event.currentTarget.value))}
      />
      <label class="scrubber-speed">
        <span class="unseen">{t("Speed")}</span>
        <select
          class="input"
          value={String(moment.speed.value)}
          onChange={(event) => moment.playAt(Number(event.currentTarget.value))}
        >
          {SPEEDS.map((speed) => (
            <option key={speed} value={String(speed)}>
              {speed}×
            </option>
          ))}
        </select>
      </label>
      <p class="scrubber-where">
        {newest ? (
          <>
            <Where going={going} /> {clock(end)}
          </>
        ) : (
          <>
            {parts("You are looking at {time} of {end}", { time: <b>{clock(time)}</b>, end: clock(end) })}
          </>
        )}
      </p>
      {!newest && <CopyLink time={time} />}
      {!newest && (
        <button type="button" class="button primary scrubber-back" onClick={moment.goToNewest}>
          {going ? t("Back to live") : t("To the end")}
        </button>
      )}
    </section>
  );
}

const FAULT_BEFORE = "M2 10l3-2.5v5zM14 5l4.5 9h-9z";
const FAULT_AFTER = "M18 10l-3-2.5v5zM6 5l4.5 9h-9z";

function FaultButton({ name, keys, d, go }: { name: string; keys: string; d: string; go: (() => void) | null }) {
  return (
    <button
      type="button"
      class="bare icon-button"
      aria-label={name}
      aria-keyshortcuts={keys}
      title={`${name} (${keys.replace("Arrow", "").replace("Left", "←").replace("Right", "→")})`}
      aria-disabled={go === null}
      onClick={() => go?.()}
    >
      <Icon d={d} />
    </button>
  );
}

function Icon({ d }: { d: string }) {
  return (
    <svg viewBox="0 0 20 20" width="20" height="20" aria-hidden="true">
      <path d={d} />
    </svg>
  );
}

/** Nothing is live that no longer comes. */
function Where({ going }: { going: boolean }) {
  if (!going) return <b>{t("The end")}</b>;
  return connection.value === "connected" ? <b class="live">{t("Live")}</b> : <b>{t("Not connected, last seen")}</b>;
}

const LINK = "M8 12l4-4M9 6l2-2a3.5 3.5 0 0 1 5 5l-2 2M11 14l-2 2a3.5 3.5 0 0 1-5-5l2-2";

function CopyLink({ time }: { time: number }) {
  const [copied, setCopied] = useState<number | null>(null);
  const copy = () =>
    navigator.clipboard.writeText(location.origin + withMoment(location.pathname, time)).then(
      () => setCopied(time),
      () => setCopied(null),
    );
  const words = copied === time ? t("Link copied") : t("Copy link");
  // Pages that came over plain http from elsewhere have no clipboard; the address says the same.
  if (navigator.clipboard === undefined) return null;
  return (
    <button type="button" class="button scrubber-copy" aria-label={words} onClick={() => void copy()}>
      <Icon d={copied === time ? "M4 10l4 4 8-9-8 9z" : LINK} />
      <span>{words}</span>
    </button>
  );
}

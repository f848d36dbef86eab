// The moment of a run that the whole view shows: the newest, or one in its past.
import { computed, type ReadonlySignal, signal } from "@preact/signals";

export const SPEEDS = [0.5, 1, 2, 4, 8] as const;

export interface Moment {
  /** Seconds of the run's clock that are shown: the newest known, or the chosen ones. */
  readonly time: ReadonlySignal<number>;
  /** Of several events at `time`, the last one that counts; null counts them all. */
  readonly seq: ReadonlySignal<number | null>;
  /** Whether the newest is shown as it comes. Of a run that has ended that is its end. */
  readonly newest: ReadonlySignal<boolean>;
  /** Whether the run goes on and its newest is shown: only then are live pictures the right ones. */
  readonly live: ReadonlySignal<boolean>;
  /** The newest time known of the run. */
  readonly end: ReadonlySignal<number>;
  readonly playing: ReadonlySignal<boolean>;
  /** Run seconds per second while playing. */
  readonly speed: ReadonlySignal<number>;
  /** The run has come as far as `time`; whoever hears of it says so (events, poses). */
  reach(time: number): void;
  /** The run has ended. */
  finish(): void;
  /** Show a moment; from the end on the newest is followed again, unless `seq` names an event. */
  goTo(time: number, seq?: number | null): void;
  goToNewest(): void;
  /** Play on from the moment shown, from the beginning if that is the end. */
  play(): void;
  pause(): void;
  playAt(speed: number): void;
  /** Let `seconds` of real time pass. */
  advance(seconds: number): void;
}

interface Chosen {
  time: number;
  seq: number | null;
}

export function createMoment(): Moment {
  const end = signal(0);
  const ended = signal(false);
  const chosen = signal<Chosen | null>(null);
  const playing = signal(false);
  const speed = signal<number>(1);
  const goTo = (time: number, seq: number | null = null) => {
    const within = Math.min(Math.max(time, 0), end.value);
    chosen.value = within >= end.value && seq === null ? null : { time: within, seq };
    if (chosen.value === null) playing.value = false;
  };
  return {
    time: computed(() => chosen.value?.time ?? end.value),
    seq: computed(() => chosen.value?.seq ?? null),
    newest: computed(() => chosen.value === null),
    live: computed(() => chosen.value === null && !ended.value),
    end,
    playing,
    speed,
    reach(time) {
      if (time > end.value) end.value = time;
    },
    finish() {
      ended.value = true;
    },
    goTo,
    goToNewest: () => goTo(Infinity),
    play() {
      if (chosen.value === null) goTo(0);
      playing.value = chosen.value !== null;
    },
    pause() {
      playing.value = false;
    },
    playAt(next) {
      speed.value = next;
    },
    advance(seconds) {
      if (playing.value && chosen.value !== null) goTo(chosen.value.time + seconds * speed.value);
    },
  };
}

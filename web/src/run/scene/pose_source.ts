// Where the scene gets its poses from: live ones while the newest is shown, recorded ones else.
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import * as rest from "../../wire/rest";
import type { Layout } from "../../wire/types";
import type { Moment } from "../moment";
import { decodeFrames, type Frame } from "./decode";
import { createPoseBuffer } from "./interpolate";
import { watchRun, type WatchState } from "./live_poses";
import { createRecordedPoses } from "./recorded_poses";
import type { Poses } from "./scene_view";

// Often enough for a timeline to grow evenly, and no more work for the rest of the view than that.
const REACH_STEP_S = 0.25;

export interface Whereabouts {
  readonly name: string;
  readonly kind: "object" | "obstacle";
  readonly held: boolean;
  readonly gone: boolean;
  readonly hidden: boolean;
}

export interface PoseSource extends Poses {
  readonly layout: ReadonlySignal<Layout | null>;
  readonly state: ReadonlySignal<WatchState>;
  /** Whether there is nothing to show at the chosen moment. */
  readonly nothing: ReadonlySignal<boolean>;
  /** As the layout's objects; set only when it differs from before. */
  readonly whereabouts: ReadonlySignal<readonly Whereabouts[]>;
  /** What is known of the moment itself, never a stand-in for it; null for nothing. */
  known(now: number): Frame | null;
  /** When the newest frame came (milliseconds of this page); the first of a connection may be old, and says nothing. */
  heard(): number | null;
  /** Hear that there is something new to show. */
  onChange(listener: () => void): void;
  close(): void;
}

export function createPoseSource(run: string, helper: string, moment: Moment): PoseSource {
  const layout = signal<Layout | null>(null);
  const state = signal<WatchState>("connecting");
  const nothing = signal(false);
  const whereabouts = signal<readonly Whereabouts[]>([]);
  const buffer = createPoseBuffer();
  let newest: Frame | null = null;
  let past: Frame | null = null;
  let recordedThen: Frame | null = null;
  let first = true;
  let heard: number | null = null;
  let wanted = 0;
  let changed = () => {};

  const tell = (frame: Frame) => {
    const next = whereaboutsIn(frame, layout.peek());
    if (JSON.stringify(next) !== JSON.stringify(whereabouts.peek())) whereabouts.value = next;
    changed();
  };
  const takeLayout = (next: Layout) => {
    if (JSON.stringify(next) === JSON.stringify(layout.peek())) return;
    layout.value = next;
    // A frame that came before it said nothing by itself.
    const frame = moment.live.peek() ? newest : (past ?? newest);
    if (frame !== null) tell(frame);
  };
  const stopWatching = watchRun(run, helper, {
    layout: takeLayout,
    frame(frame) {
      newest = frame;
      if (!first) heard = performance.now();
      first = false;
      buffer.push(frame, performance.now());
      if (frame.time > moment.end.peek() + REACH_STEP_S) moment.reach(frame.time);
      if (moment.live.peek()) tell(frame);
    },
    state(next) {
      state.value = next;
      if (next === "connecting" || next === "watching" || next === "lost") first = true;
      if (next === "lost") buffer.clear();
      if (next === "ended" && newest !== null) moment.reach(newest.time);
    },
  });

  const recorded = createRecordedPoses(
    async (from, to) => {
      const { bytes, recorded } = await rest.poses(run, from, to);
      return { frames: decodeFrames(bytes), recorded };
    },
    () => state.peek() === "ended",
  );
  const stopReplaying = effect(() => {
    if (moment.live.value) {
      past = recordedThen = null;
      nothing.value = false;
      if (newest !== null) tell(newest);
      return;
    }
    void replay(moment.time.value);
  });

  async function replay(time: number): Promise<void> {
    wanted += 1;
    const mine = wanted;
    // The newest known is a good stand-in where the record cannot be read.
    const found = await recorded.at(time).catch(() => undefined);
    if (mine !== wanted || moment.live.peek()) return;
    recordedThen = found ?? null;
    const frame = found === undefined ? (past ?? newest) : found;
    past = frame;
    nothing.value = frame === null;
    if (frame !== null) tell(frame);
    else changed();
  }

  return {
    layout,
    state,
    nothing,
    whereabouts,
    at: (now) => (moment.live.peek() ? (buffer.at(now) ?? newest) : (past ?? newest)),
    known: (now) => (moment.live.peek() ? (buffer.at(now) ?? newest) : recordedThen),
    heard: () => heard,
    moving: (now) => moment.live.peek() && buffer.moving(now),
    onChange(listener) {
      changed = listener;
    },
    close() {
      stopWatching();
      stopReplaying();
      changed = () => {};
    },
  };
}

function whereaboutsIn(frame: Frame, layout: Layout | null): Whereabouts[] {
  return (layout?.objects ?? []).flatMap(({ name, kind }, index) => {
    const shown = frame.objects[index];
    if (shown === undefined) return [];
    const { held, gone, hidden } = shown;
    return [{ name, kind, held, gone, hidden }];
  });
}

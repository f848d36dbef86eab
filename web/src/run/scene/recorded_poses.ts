// The recorded poses of a run, read in spans as they are looked at, and kept.
import type { Frame } from "./decode";
import { between } from "./interpolate";

const SPAN_S = 30;

export interface Reading {
  readonly frames: readonly Frame[];
  /** The first and last recorded times of the run; null when nothing is recorded. */
  readonly recorded: readonly [number, number] | null;
}

export type Read = (from: number, to: number) => Promise<Reading>;

export interface RecordedPoses {
  /** Where everything was at a time of the run; null when nothing is recorded. */
  at(time: number): Promise<Frame | null>;
}

interface Span {
  readonly frames: readonly Frame[];
  /** Whether the run can no longer add to it. */
  readonly whole: boolean;
}

/** `ended` says whether the run can no longer record anything. */
export function createRecordedPoses(read: Read, ended: () => boolean): RecordedPoses {
  const spans = new Map<number, Promise<Span>>();
  let first = 0;

  const load = (index: number) => {
    const over = ended();
    const loading = read(index * SPAN_S, (index + 1) * SPAN_S).then(({ frames, recorded }) => {
      first = recorded?.[0] ?? 0;
      return { frames, whole: over || (recorded !== null && recorded[1] > (index + 1) * SPAN_S) };
    });
    spans.set(index, loading);
    loading.catch(() => spans.delete(index));
    return loading;
  };

  const span = async (index: number, upTo: number): Promise<readonly Frame[]> => {
    const known = await (spans.get(index) ?? load(index));
    const covers = known.whole || (known.frames.at(-1)?.time ?? -1) >= upTo;
    return covers ? known.frames : (await load(index)).frames;
  };

  return {
    async at(time) {
      const index = Math.floor(time / SPAN_S);
      const here = await span(index, time);
      const next = here.findIndex((frame) => frame.time > time);
      const after = next === -1 ? undefined : here[next];
      const before = here[next === -1 ? here.length - 1 : next - 1] ?? (await lastBefore(index));
      if (before === undefined) return after ?? null;
      if (after === undefined) return before;
      return between(before, after, (time - before.time) / (after.time - before.time));
    },
  };

  /** While nothing moves nothing is recorded, so that the frame that holds may be spans away. */
  async function lastBefore(index: number): Promise<Frame | undefined> {
    for (let earlier = index - 1; earlier >= Math.floor(first / SPAN_S) && earlier >= 0; earlier -= 1) {
      const last = (await span(earlier, 0)).at(-1);
      if (last !== undefined) return last;
    }
    return undefined;
  }
}

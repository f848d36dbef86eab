// Where each robot is at the moment that is shown, whether it moves, and whether that is still true.
import type { Frame } from "../run/scene/decode";

/** What is older is where a robot was, not where it is. */
export const OLD_S = 3;
/** Who has not moved for so long stands. */
const STANDS_S = 1.2;
const MOVED_M = 0.08;
/** After more than this the moment is another one, and nobody has moved from one to the other. */
const ANOTHER_MOMENT_S = 5;
/** A record that begins so little after a moment begins with it. */
const BEGINS_S = 0.5;

export interface Standing {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  /** Radians, anticlockwise from x. */
  readonly yaw: number;
  readonly moving: boolean;
  /** How long ago it was seen there, s; null while that is now. */
  readonly seen_s: number | null;
  /** How sure it is of x and y: variances and covariance xx, xy, yy, square metres; unset where nobody tells. */
  readonly covariance?: readonly number[] | null;
}

/** How far what is shown is behind: `time` is the run's clock that is shown, `silent_s` counts since the last frame. */
export interface Shown {
  readonly time: number;
  readonly silent_s: number;
  /** From how many seconds on a pose is an old one. */
  readonly old_s: number;
}

interface Track {
  readonly x: number;
  readonly y: number;
  readonly moved: number;
  readonly last: number;
}

export interface Standings {
  /** In the order of the frame's robots; null for a robot of which nothing is known. */
  at(frame: Frame | null, shown: Shown): readonly (Standing | null)[];
}

/** It remembers where robots were before, to tell who moves. */
export function createStandings(): Standings {
  const tracks: Track[] = [];
  return {
    at(frame, { time, silent_s, old_s }) {
      // What was recorded later says nothing of a moment before.
      if (frame === null || frame.time > time + BEGINS_S) return [];
      return frame.robots.map(({ pose, age }, index) => {
        if (age === Infinity) return null;
        const [x = 0, y = 0, z = 0] = pose;
        const track = (tracks[index] = followed(tracks[index], x, y, frame.time));
        const ago = Math.max(0, time - frame.time) + age + silent_s;
        const seen_s = ago >= old_s ? ago : null;
        return { x, y, z, yaw: yawOf(pose), moving: seen_s === null && frame.time - track.moved < STANDS_S, seen_s };
      });
    },
  };
}

function followed(track: Track | undefined, x: number, y: number, time: number): Track {
  const another = track === undefined || time < track.last || time - track.last > ANOTHER_MOMENT_S;
  if (another || Math.hypot(x - track.x, y - track.y) >= MOVED_M) return { x, y, moved: time, last: time };
  return { ...track, last: time };
}

function yawOf(pose: ArrayLike<number>): number {
  const [, , , x = 0, y = 0, z = 0, w = 1] = Array.from(pose);
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/** "12 s", "3 min", "5 h" */
export function howLong(seconds: number): string {
  if (seconds < 120) return `${Math.floor(seconds)} s`;
  return seconds < 7200 ? `${Math.floor(seconds / 60)} min` : `${Math.floor(seconds / 3600)} h`;
}

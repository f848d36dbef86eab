// How finely to draw: as finely as this device draws often enough, and coarser where it cannot.

const WANTED_MS = 33;
const LOOKED_AT = 10;
// Frames of the display come a little earlier or later.
const JITTER_MS = 2;
// After a longer pause nothing was to be drawn.
const PAUSE_MS = 400;

export interface Detail {
  /** Of the device's own pixel ratio, up to the highest that is used. */
  readonly pixels: number;
  readonly shadows: boolean;
}

const LADDER: readonly Detail[] = [
  { pixels: 1, shadows: true },
  { pixels: 0.75, shadows: true },
  { pixels: 0.75, shadows: false },
  { pixels: 0.5, shadows: false },
];

/** Where no graphics processor helps: shadows would cost more than all the rest. */
const LADDER_BY_SOFTWARE: readonly Detail[] = [
  { pixels: 1, shadows: false },
  { pixels: 0.75, shadows: false },
  { pixels: 0.5, shadows: false },
];

export interface Pace {
  readonly first: Detail;
  /** Whether to leave out a frame of the display: by software each takes much of a core, and poses come less often. */
  early(now: number): boolean;
  /**
   * Hear of each drawing's time (milliseconds); answers with less detail when they come too slowly,
   * else with null. It never goes back up, as going to and fro would be seen.
   */
  drawn(now: number): Detail | null;
}

export function createPace(bySoftware: boolean): Pace {
  const ladder = bySoftware ? LADDER_BY_SOFTWARE : LADDER;
  let rung = 0;
  let before = Number.NEGATIVE_INFINITY;
  let gaps: number[] = [];
  return {
    first: ladder[0] as Detail,
    early: (now) => bySoftware && now - before < WANTED_MS / 2 + JITTER_MS,
    drawn(now) {
      const gap = now - before;
      before = now;
      if (gap > PAUSE_MS) return null;
      gaps.push(gap);
      if (gaps.length < LOOKED_AT) return null;
      const middle = gaps.sort((a, b) => a - b)[LOOKED_AT / 2] as number;
      gaps = [];
      if (middle <= WANTED_MS + JITTER_MS || rung === ladder.length - 1) return null;
      rung += 1;
      return ladder[rung] ?? null;
    },
  };
}

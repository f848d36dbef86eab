// How finely to draw: as finely as this device draws often enough, and coarser where it cannot.

const WANTED_MS = 33;
const LOOKED_AT = 10;
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

/**
 * Hear of each drawing's time (milliseconds); answers with less detail when they come too slowly,
 * else with null. It never goes back up, as going to and fro would be seen.
 */
export function createPace(): (now: number) => Detail | null {
  let rung = 0;
  let before = Number.NEGATIVE_INFINITY;
  let gaps: number[] = [];
  return (now) => {
    const gap = now - before;
    before = now;
    if (gap > PAUSE_MS) return null;
    gaps.push(gap);
    if (gaps.length < LOOKED_AT) return null;
    const middle = gaps.sort((a, b) => a - b)[LOOKED_AT / 2] as number;
    gaps = [];
    if (middle <= WANTED_MS + 2 || rung === LADDER.length - 1) return null;
    rung += 1;
    return LADDER[rung] ?? null;
  };
}

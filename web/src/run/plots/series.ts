// A number of a run over its clock.

export interface Point {
  /** Seconds of the run's clock. */
  readonly time: number;
  readonly value: number;
  /** The event that tells it; null where it was recorded besides. */
  readonly seq: number | null;
}

export interface Series {
  readonly id: string;
  /** What it is, as people say it. */
  readonly name: string;
  readonly unit: string;
  /** In the order of their times. */
  readonly points: readonly Point[];
}

const UNITS: readonly (readonly [string, string])[] = [
  ["_m_s", "m/s"],
  ["_rad", "rad"],
  ["_m", "m"],
  ["_s", "s"],
  ["_px", "px"],
  ["_n", "N"],
];

/** What the ending of a field's name says that it counts in, and the name without it. */
export function unitOf(field: string): readonly [name: string, unit: string] {
  const known = UNITS.find(([ending]) => field.endsWith(ending));
  return known === undefined ? [field, ""] : [field.slice(0, -known[0].length), known[1]];
}

/** How many points there are up to a time. */
export function countUntil(points: readonly Point[], time: number): number {
  let low = 0;
  let high = points.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((points[middle] as Point).time <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** A value with as many digits as tell something. */
export function told(value: number, unit: string): string {
  const digits = String(Number.isInteger(value) ? value : Number(value.toPrecision(Math.abs(value) < 1000 ? 4 : 7)));
  return unit === "" ? digits : `${digits} ${unit}`;
}

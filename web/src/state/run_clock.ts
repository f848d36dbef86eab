// What a run's clock says now, estimated from the last event: deadlines are told in its time.

interface Reading {
  time: number;
  /** This page's clock at that moment, s. */
  at: number;
}

const readings = new Map<string, Reading>();

/** Note what a run's clock said just now. */
export function readRunClock(run: string, time: number, now = pageTime()): void {
  const before = readings.get(run);
  if (before === undefined || time >= before.time) readings.set(run, { time, at: now });
}

/** Seconds on the run's clock; while somebody is asked it runs at most at real time. */
export function runTime(run: string, speed: number | "max", now = pageTime()): number {
  const last = readings.get(run);
  if (last === undefined) return 0;
  return last.time + (now - last.at) * rateOf(speed);
}

/** When a time of a run's clock will have come, on the page's own (s), at the rate of `runTime`. */
export function endOf(run: string, time: number, speed: number | "max"): number {
  const last = readings.get(run);
  return last === undefined ? Infinity : last.at + (time - last.time) / rateOf(speed);
}

function rateOf(speed: number | "max"): number {
  return speed === "max" ? 1 : Math.min(1, speed);
}

function pageTime(): number {
  return performance.now() / 1000;
}

// All known events of a run, and its state after any of them without folding from the beginning.
import type { Told } from "../wire/told";
import { begin, fold, type RunState } from "./fold";

/** So far apart are the states that are kept; at most as many events are folded for one in between. */
const CHECKPOINT_EVERY = 64;

export interface History {
  readonly events: readonly Told[];
  /** Take events that follow; those that are known already are left out. Returns whether any was new. */
  add(events: readonly Told[]): boolean;
  /** How many events had happened at `time`; with `seq`, those up to that event alone. */
  countAt(time: number, seq?: number | null): number;
  /** The state after the first `count` events; null for none. */
  stateAfter(count: number): RunState | null;
}

export function createHistory(): History {
  const events: Told[] = [];
  const checkpoints: RunState[] = [];
  let newest: RunState | null = null;
  let latest: { count: number; state: RunState } | null = null;

  const add = (more: readonly Told[]): boolean => {
    const before = events.length;
    for (const event of more) {
      if (event.seq <= (newest?.seq ?? -1)) continue;
      if (newest !== null) newest = fold(newest, event);
      else if (event.type === "run_started") newest = begin(event);
      else throw new Error(`expected a run to begin with run_started, got ${event.type}`);
      if (events.length % CHECKPOINT_EVERY === 0) checkpoints.push(newest);
      events.push(event);
    }
    return events.length > before;
  };

  const countAt = (time: number, seq: number | null = null): number => {
    let low = 0;
    let high = events.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      const event = events[middle] as Told;
      const happened = seq === null ? event.time <= time : event.seq <= seq;
      if (happened) low = middle + 1;
      else high = middle;
    }
    return low;
  };

  const stateAfter = (count: number): RunState | null => {
    if (count <= 0 || newest === null) return null;
    if (count >= events.length) return newest;
    if (latest?.count === count) return latest.state;
    const onward = latest !== null && latest.count < count && count - latest.count < CHECKPOINT_EVERY;
    const checkpoint = Math.floor((count - 1) / CHECKPOINT_EVERY);
    let state = onward && latest !== null ? latest.state : (checkpoints[checkpoint] as RunState);
    let folded = onward && latest !== null ? latest.count : checkpoint * CHECKPOINT_EVERY + 1;
    for (; folded < count; folded++) state = fold(state, events[folded] as Told);
    latest = { count, state };
    return state;
  };

  return { events, add, countAt, stateAfter };
}

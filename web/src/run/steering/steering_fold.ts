// How a run is steered, after some of its events: a pure fold, as the service's own.
import type { AutonomyLevel, BreakpointSet, LeafHeld, LeafPreferred, RunStarted } from "../../wire/types";
import type { Told } from "../../wire/told";

export interface Steering {
  readonly autonomy: AutonomyLevel;
  /** By path, as are the leaves before which a robot was seen to wait. */
  readonly breakpoints: ReadonlyMap<string, BreakpointSet>;
  readonly waiting: ReadonlyMap<string, LeafHeld>;
  readonly preferred: LeafPreferred | null;
}

export const LEVELS: readonly AutonomyLevel[] = ["off", "low", "high", "full"];

export function beginSteering({ options }: RunStarted): Steering {
  const autonomy = LEVELS.find((level) => level === options.autonomy) ?? "full";
  return { autonomy, breakpoints: new Map(), waiting: new Map(), preferred: null };
}

/** The same object where the event says nothing of it. */
export function foldSteering(steering: Steering, event: Told): Steering {
  switch (event.type) {
    case "breakpoint_set":
      return { ...steering, breakpoints: new Map(steering.breakpoints).set(event.node, event) };
    case "breakpoint_removed":
      // Whoever still has a reason to wait says so anew.
      return { ...steering, breakpoints: without(steering.breakpoints, event.node), waiting: new Map() };
    case "autonomy_set":
      return { ...steering, autonomy: event.level, waiting: new Map() };
    case "leaf_held":
      return { ...steering, waiting: new Map(steering.waiting).set(event.node, event) };
    case "leaf_preferred":
      return { ...steering, preferred: event };
    case "leaf_not_preferred":
      return { ...steering, preferred: null };
    case "leaf_let_go":
    case "leaf_tried_again":
      return steering.waiting.has(event.node) ? { ...steering, waiting: without(steering.waiting, event.node) } : steering;
    case "node_started":
    case "node_taken":
    case "node_left_out":
      return begun(steering, event.node);
    default:
      return steering;
  }
}

function begun(steering: Steering, node: string): Steering {
  const preferred = steering.preferred?.node === node ? null : steering.preferred;
  const known = steering.waiting.has(node);
  if (preferred === steering.preferred && !known) return steering;
  return { ...steering, preferred, waiting: known ? without(steering.waiting, node) : steering.waiting };
}

function without<T>(map: ReadonlyMap<string, T>, key: string): ReadonlyMap<string, T> {
  const next = new Map(map);
  next.delete(key);
  return next;
}

// How people steer the nodes of a tree, for its drawing.
import type { Steered } from "../../tree/tree_node";
import type { LeafHeld } from "../../wire/types";
import type { Steering } from "./steering_fold";

export function steeredOf({ breakpoints, preferred }: Steering, waits: readonly LeafHeld[]): ReadonlyMap<string, Steered> {
  const steered = new Map<string, Steered>();
  const of = (node: string): Steered => {
    const known = steered.get(node) ?? { breakpoint: false, waits: false, next: false };
    steered.set(node, known);
    return known;
  };
  for (const node of breakpoints.keys()) of(node).breakpoint = true;
  if (preferred !== null) of(preferred.node).next = true;
  for (const { node, breakpoint } of waits) {
    of(node).waits = true;
    if (breakpoint !== null) of(breakpoint).waits = true;
  }
  return steered;
}

// What of a building is picked on its plan, for something to be done there.
import type { ClosedWayView } from "../wire/types";

/** Names are a building's, as FLOOR/PLACE. */
export type Picked =
  | { readonly kind: "way"; readonly between: readonly [string, string] }
  | { readonly kind: "place"; readonly place: string }
  | null;

export function sameWay(a: readonly string[], b: readonly string[]): boolean {
  return a.length === b.length && a.every((each) => b.includes(each));
}

/** How a way is closed now; undefined where it is open. */
export function closedWay(closed: readonly ClosedWayView[], between: readonly string[]): ClosedWayView | undefined {
  return closed.find((each) => sameWay(each.between, between));
}

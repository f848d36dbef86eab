// Before which leaves a robot waits now to be let go: those whose turn it still is.
import type { LeafHeld, NodeView } from "../../wire/types";
import { ended, nodeViews, type RunState } from "../fold";

export function waitsOf(state: RunState): readonly LeafHeld[] {
  const { waiting } = state.steering;
  if (waiting.size === 0 || ended(state.status)) return [];
  // A paused run has the same order as one that goes on.
  const views = nodeViews({ ...state, status: "running" });
  const turn = new Map(views.map((view) => [view.node, view]));
  return views
    .filter((view) => waiting.has(view.node) && hasItsTurn(view))
    .map((view) => waiting.get(view.node) as LeafHeld)
    .filter(({ breakpoint }) => breakpoint === null || !hasBegun(breakpoint, turn, views));
}

/** Whether a leaf could be begun, of a run that goes on. */
export function hasItsTurn({ active, done, abandoned, activation_level }: NodeView): boolean {
  return !active && !done && !abandoned && activation_level > 0;
}

/** Whether anything under a node is active or done: its breakpoint holds nothing then. */
function hasBegun(path: string, turn: ReadonlyMap<string, NodeView>, views: readonly NodeView[]): boolean {
  const node = turn.get(path);
  if (node === undefined || node.active || node.done) return true;
  const under = path === "/" ? "/" : `${path}/`;
  return views.some((view) => view.done && view.node.startsWith(under) && view.node !== path);
}

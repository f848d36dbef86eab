// The signs of kinds and states, each in a square of 20 by 20.
import type { ComponentChildren } from "preact";
import type { NodeKind, NodeState } from "./tree_node";

const KIND_SIGNS: Readonly<Record<Exclude<NodeKind, "behavior">, ComponentChildren>> = {
  // An arrow: one after the other.
  then: <path d="M3 10h13M11 5l5 5-5 5" />,
  // A brace around all of them.
  and: <path d="M12 3c-3 0-3 2-3 4s0 3-3 3c3 0 3 1 3 3s0 4 3 4" />,
  // A fork: one way or another.
  or: <path d="M3 10h5l7-6M8 10l7 6M11.5 3.5h4v4M11.5 16.5h4v-4" />,
};

const STATE_SIGNS: Readonly<Record<NodeState, ComponentChildren>> = {
  waiting: <circle cx="10" cy="10" r="6" />,
  eligible: (
    <>
      <circle cx="10" cy="10" r="6" />
      <circle class="solid" cx="10" cy="10" r="2.5" />
    </>
  ),
  active: (
    <>
      <circle class="solid" cx="10" cy="10" r="8" />
      <path class="cut" d="M8 6.5v7l5.5-3.5z" />
    </>
  ),
  in_dialogue: (
    <>
      <path class="solid" d="M3 3h14v11h-7l-4 4v-4H3z" />
      <path class="cut-line" d="M8 7a2 2 0 1 1 2.6 1.900v.8M10.6 11.6v.1" />
    </>
  ),
  done: (
    <>
      <circle class="solid" cx="10" cy="10" r="8" />
      <path class="cut-line" d="M6 10.5l3 3 5-6.5" />
    </>
  ),
  abandoned: <path d="M5 5l10 10M15 5L5 15" />,
  failed: (
    <>
      <circle class="solid" cx="10" cy="10" r="8" />
      <path class="cut-line" d="M7 7l6 6M13 7l-6 6" />
    </>
  ),
  left: <path d="M5 10h10" />,
};

export function KindSign({ kind, x, y }: { kind: Exclude<NodeKind, "behavior">; x: number; y: number }) {
  return (
    <g class="sign kind" transform={`translate(${x} ${y})`}>
      {KIND_SIGNS[kind]}
    </g>
  );
}

export function StateSign({ state, x, y }: { state: NodeState; x: number; y: number }) {
  return (
    <g class={`sign state ${state}`} transform={`translate(${x} ${y})`}>
      {STATE_SIGNS[state]}
    </g>
  );
}

/** A mark on the upper edge of a card that has a mistake, around `x`. */
export function WrongSign({ x }: { x: number }) {
  return (
    <g class="wrong-sign" aria-hidden="true" transform={`translate(${x - 6} 2)`}>
      <circle r={9} />
      <path d="M0 -4.5v5M0 3.5v.6" />
    </g>
  );
}

/** A stop sign on the side from which a node is come to; filled while a robot waits there. */
export function BreakpointSign({ waits, y }: { waits: boolean; y: number }) {
  return (
    <g class={`breakpoint ${waits ? "waits" : ""}`} transform={`translate(0 ${y})`}>
      <path d="M-3.300 -8H3.300L8 -3.300V3.300L3.300 8H-3.300L-8 3.300V-3.300Z" />
    </g>
  );
}

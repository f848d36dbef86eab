// One floor: walls, doors, lanes and places. It is moved and zoomed by one attribute.
import type { ComponentChildren } from "preact";
import { useMemo } from "preact/hooks";
import type { PlaceKind, PlanFloor, Segment } from "./plan";
import type { Sight } from "./sight";
import { t } from "../words/words";

const KINDS: readonly PlaceKind[] = ["room", "charger", "parking", "elevator"];

interface FloorDrawingProps {
  floor: PlanFloor;
  sight: Sight;
  label: string;
  /** What is drawn over it, in pixels. */
  children?: ComponentChildren;
}

export function FloorDrawing({ floor, sight, label, children }: FloorDrawingProps) {
  // As long as the floor is the same nothing of it is looked at again.
  const drawn = useMemo(() => <Drawn floor={floor} />, [floor]);
  const { scale, left, top } = sight;
  return (
    <svg class="plan-drawing" role="img" aria-label={label}>
      <g transform={`translate(${left} ${top}) scale(${scale} ${-scale})`}>{drawn}</g>
      {children}
    </svg>
  );
}

function Drawn({ floor }: { floor: PlanFloor }) {
  const { walls, lanes, doors, places } = floor;
  return (
    <>
      <path class="plan-lanes" d={lines(lanes.map((each) => each.segment))} />
      <path class="plan-walls" d={lines(walls)} />
      <path class="plan-doors people" d={lines(doors.filter((each) => !each.opensItself).map((each) => each.segment))} />
      <path class="plan-doors itself" d={lines(doors.filter((each) => each.opensItself).map((each) => each.segment))} />
      {KINDS.map((kind) => (
        // Points: lines without length, whose ends are as large at every scale.
        <path
          key={kind}
          class={`plan-places ${kind}`}
          d={places.filter((each) => each.kind === kind).map(({ x, y }) => `M${x} ${y}h0`).join("")}
        />
      ))}
    </>
  );
}

function lines(segments: readonly Segment[]): string {
  return segments.map(([x0, y0, x1, y1]) => `M${x0} ${y0}L${x1} ${y1}`).join("");
}

const KIND_WORDS: Readonly<Record<PlaceKind, string>> = {
  waypoint: t("waypoint"),
  room: t("room"),
  charger: t("charger"),
  parking: t("parking"),
  elevator: t("elevator"),
};

/** What the signs mean that a floor has. */
export function FloorLegend({ floor }: { floor: PlanFloor }) {
  const kinds = KINDS.filter((kind) => floor.places.some((each) => each.kind === kind));
  return (
    <ul class="plan-legend small quiet" aria-label={t("Signs of the plan")}>
      {kinds.map((kind) => (
        <li key={kind}>
          <svg width="16" height="16" viewBox="-8 -8 16 16" aria-hidden="true">
            <path class={`plan-places ${kind}`} d="M0 0h0" />
          </svg>
          {KIND_WORDS[kind]}
        </li>
      ))}
      {floor.doors.length > 0 && (
        <li>
          <svg width="16" height="16" viewBox="-8 -8 16 16" aria-hidden="true">
            <path class="plan-doors people" d="M-7 0L7 0" />
          </svg>{t("door")}</li>
      )}
    </ul>
  );
}

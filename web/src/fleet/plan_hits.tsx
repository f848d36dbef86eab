// What of a floor can be picked: its lanes, with the doors on them, and its places. Closed ways are drawn.
import type { PlanFloor, PlanLane } from "../building/plan";
import { drawnAt, type Sight } from "../building/sight";
import type { ClosedWayView } from "../wire/types";
import { closedWay, type Picked, sameWay } from "./picked";

const PLACE_PX = 11;

interface PlanHitsProps {
  floor: PlanFloor;
  sight: Sight;
  closed: readonly ClosedWayView[];
  picked: Picked;
  onPick(picked: Picked): void;
}

/** Under the pointer only: with the keys ways and places are chosen in lists. */
export function PlanHits({ floor, sight, closed, picked, onPick }: PlanHitsProps) {
  const named = (lane: PlanLane) => lane.between.map((each) => `${floor.name}/${each}`) as [string, string];
  return (
    <svg class="plan-hits" aria-hidden="true">
      {floor.lanes.map((lane) => {
        const between = named(lane);
        const [from, to] = [drawnAt(sight, lane.segment[0], lane.segment[1]), drawnAt(sight, lane.segment[2], lane.segment[3])];
        const line = { x1: from.x, y1: from.y, x2: to.x, y2: to.y };
        const isClosed = closedWay(closed, between) !== undefined;
        const isPicked = picked?.kind === "way" && sameWay(picked.between, between);
        return (
          <g key={between.join(" ")} data-way={between.join(" ")} class={isClosed ? "closed" : ""} onClick={() => onPick({ kind: "way", between })}>
            {isPicked && <line class="picked-way" {...line} />}
            {isClosed && <ClosedSign {...line} />}
            <line class="hit" {...line} />
          </g>
        );
      })}
      {floor.places.map(({ name, x, y }) => {
        const at = drawnAt(sight, x, y);
        const place = `${floor.name}/${name}`;
        return (
          <g key={place} data-place={place} onClick={() => onPick({ kind: "place", place })}>
            {picked?.kind === "place" && picked.place === place && <circle class="picked-place" cx={at.x} cy={at.y} r={PLACE_PX} />}
            <circle class="hit" cx={at.x} cy={at.y} r={PLACE_PX} />
          </g>
        );
      })}
    </svg>
  );
}

function ClosedSign(line: { x1: number; y1: number; x2: number; y2: number }) {
  const [x, y] = [(line.x1 + line.x2) / 2, (line.y1 + line.y2) / 2];
  return (
    <>
      <line class="closed-way" {...line} />
      <circle class="closed-sign" cx={x} cy={y} r={9} />
      <path class="closed-cross" d={`M${x - 4} ${y - 4}l8 8M${x + 4} ${y - 4}l-8 8`} />
    </>
  );
}

// The names of a floor's places, as many as have room; those under something else are left out.
import { useMemo } from "preact/hooks";
import { type Named, placeLabels, type Rect } from "./labels";
import type { PlaceKind, PlanFloor } from "./plan";
import type { Sight, Size } from "./sight";
import { textWidth } from "./text_width";

const HEIGHT_PX = 14;
const BASELINE_PX = 11;
const CLEAR_PX = 5;
const BEYOND_PX = 20;
/** What people look for first is named first. */
const RANKS: Readonly<Record<PlaceKind, number>> = { elevator: 0, charger: 1, room: 2, parking: 3, waypoint: 4 };

export interface PlacedName {
  readonly name: string;
  readonly rect: Rect;
}

/** In pixels from the plan's origin, so that they hold however the floor is moved. */
export function useNames(floor: PlanFloor, scale: number): readonly PlacedName[] {
  return useMemo(() => namesOf(floor, scale), [floor, scale]);
}

function namesOf({ places, box }: PlanFloor, scale: number): readonly PlacedName[] {
  const shown = places
    .filter(({ kind }) => kind !== "waypoint")
    .toSorted((a, b) => RANKS[a.kind] - RANKS[b.kind]);
  const named = shown.map(({ name, x, y }): Named => {
    const size = { width: textWidth(name), height: HEIGHT_PX };
    return { id: name, x: x * scale, y: -y * scale, clear: CLEAR_PX, ...size, always: false };
  });
  const marks = shown.map(({ x, y }) => around(x * scale, -y * scale, CLEAR_PX));
  const placed = placeLabels(named, marks, {
    left: box.left * scale - BEYOND_PX,
    top: -box.top * scale - BEYOND_PX,
    right: box.right * scale + BEYOND_PX,
    bottom: -box.bottom * scale + BEYOND_PX,
  });
  return named.flatMap(({ id, width, height }) => {
    const at = placed.get(id);
    return at === undefined ? [] : [{ name: id, rect: { ...at, right: at.left + width, bottom: at.top + height } }];
  });
}

function around(x: number, y: number, radius: number): Rect {
  return { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius };
}

export function PlaceNames({ names, sight, hidden }: { names: readonly PlacedName[]; sight: Sight; hidden: ReadonlySet<string> }) {
  return (
    <g class="plan-names" transform={`translate(${sight.left} ${sight.top})`} aria-hidden="true">
      {names.map(({ name, rect }) =>
        hidden.has(name) ? null : (
          <text key={name} x={rect.left} y={rect.top + BASELINE_PX}>
            {name}
          </text>
        ),
      )}
    </g>
  );
}

/** Which names would be under one of some boxes, which are in pixels of the view, or are cut off by its edges. */
export function namesHidden(
  names: readonly PlacedName[],
  sight: Sight,
  size: Size,
  boxes: readonly Rect[],
): ReadonlySet<string> {
  const cut = ({ left, top, right, bottom }: Rect) =>
    left + sight.left < 0 || top + sight.top < 0 || right + sight.left > size.width || bottom + sight.top > size.height;
  const under = ({ left, top, right, bottom }: Rect) =>
    boxes.some(
      (box) =>
        box.left - sight.left < right &&
        box.right - sight.left > left &&
        box.top - sight.top < bottom &&
        box.bottom - sight.top > top,
    );
  return new Set(names.filter(({ rect }) => cut(rect) || under(rect)).map(({ name }) => name));
}

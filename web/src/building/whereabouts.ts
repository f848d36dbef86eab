// On which floor and near which place something is, in words too.
import type { Plan, PlanFloor, PlanPlace } from "./plan";
import { t } from "../words/words";

/** What is so near to a floor's height is on it, as the service has it. */
export const ON_FLOOR_M = 0.5;
/** So near to a place something is at it. */
const AT_M = 0.5;
/** Farther from every place than this nothing is near any. */
const NEAR_M = 15;

export interface Point {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

/** The floor that something stands on; null where it is between floors. */
export function floorOn(plan: Plan, z: number): PlanFloor | null {
  return plan.floors.find(({ height }) => Math.abs(height - z) < ON_FLOOR_M) ?? null;
}

/** The floor on which something is drawn: where it is on none, the nearest. */
export function floorShownAt(plan: Plan, z: number): PlanFloor {
  return plan.floors.reduce((nearest, each) =>
    Math.abs(each.height - z) < Math.abs(nearest.height - z) ? each : nearest,
  );
}

/** The nearest place that people have a name for, else any; null where there is none near. */
export function nearestPlace(floor: PlanFloor, { x, y }: { x: number; y: number }): PlanPlace | null {
  const away = (place: PlanPlace) => Math.hypot(place.x - x, place.y - y);
  const nearest = (places: readonly PlanPlace[]) =>
    places.reduce<PlanPlace | null>((best, each) => (best === null || away(each) < away(best) ? each : best), null);
  const named = nearest(floor.places.filter(({ kind }) => kind !== "waypoint"));
  if (named !== null && away(named) <= NEAR_M) return named;
  const any = nearest(floor.places);
  return any !== null && away(any) <= NEAR_M ? any : null;
}

/** "on F2, near 204" */
export function whereInWords(plan: Plan, at: Point): string {
  const floor = floorOn(plan, at.z);
  if (floor === null) return betweenFloors(plan, at.z);
  const place = nearestPlace(floor, at);
  if (place === null) return t("on {name}", { name: floor.name });
  const names = { floor: floor.name, place: place.name };
  const near = Math.hypot(place.x - at.x, place.y - at.y);
  return near <= AT_M ? t("on {floor}, at {place}", names) : t("on {floor}, near {place}", names);
}

function betweenFloors(plan: Plan, z: number): string {
  const below = plan.floors.findLast(({ height }) => height < z);
  const above = plan.floors.find(({ height }) => height > z);
  if (below === undefined) return above === undefined ? t("on no floor") : t("below {name}", { name: above.name });
  return above === undefined
    ? t("above {name}", { name: below.name })
    : t("between {below} and {above}", { below: below.name, above: above.name });
}

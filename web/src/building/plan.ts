// The building that a run's scene is set in, as it is drawn: lengths are metres, y is upwards.

export type PlaceKind = "waypoint" | "room" | "charger" | "parking" | "elevator";

export interface PlanPlace {
  readonly name: string;
  readonly x: number;
  readonly y: number;
  readonly kind: PlaceKind;
}

/** x0, y0, x1, y1 */
export type Segment = readonly [number, number, number, number];

export interface PlanDoor {
  readonly name: string;
  readonly segment: Segment;
  readonly opensItself: boolean;
}

export interface Box {
  readonly left: number;
  readonly bottom: number;
  readonly right: number;
  readonly top: number;
}

/** What robots drive from place to place of a floor, through a door or none. */
export interface PlanLane {
  readonly between: readonly [string, string];
  readonly segment: Segment;
  readonly door: PlanDoor | null;
}

export interface PlanFloor {
  readonly name: string;
  readonly height: number;
  readonly places: readonly PlanPlace[];
  readonly walls: readonly Segment[];
  readonly lanes: readonly PlanLane[];
  readonly doors: readonly PlanDoor[];
  /** All that is drawn of it. */
  readonly box: Box;
}

export interface Plan {
  readonly name: string;
  /** From the lowest to the highest. */
  readonly floors: readonly PlanFloor[];
}

/** What the service checks of a scene's setting, so far as it is drawn. What is left out is its default. */
interface Setting {
  readonly building: string;
  readonly floors: Readonly<
    Record<
      string,
      {
        readonly height?: number;
        readonly places?: Readonly<Record<string, { x: number; y: number; kind?: PlaceKind }>>;
        readonly walls?: readonly Segment[];
        readonly lanes?: readonly { between: readonly [string, string] }[];
        readonly doors?: Readonly<
          Record<string, { posts: readonly [readonly [number, number], readonly [number, number]]; opens?: string }>
        >;
      }
    >
  >;
}

/** The building of a scene; null where it is set in none. */
export function planOf(scene: unknown): Plan | null {
  const { setting } = scene as { setting?: Partial<Setting> };
  if (typeof setting?.building !== "string" || setting.floors === undefined) return null;
  const floors = Object.entries(setting.floors).map(([name, floor]) => floorOf(name, floor));
  return { name: setting.building, floors: floors.sort((a, b) => a.height - b.height) };
}

function floorOf(name: string, floor: Setting["floors"][string]): PlanFloor {
  const { height = 0, walls = [], lanes = [] } = floor;
  const places = Object.entries(floor.places ?? {}).map(([called, { x, y, kind = "waypoint" }]) => ({
    name: called,
    x,
    y,
    kind,
  }));
  const named = new Map(places.map((place) => [place.name, place]));
  const doors = Object.entries(floor.doors ?? {}).map(
    ([called, { posts, opens }]): PlanDoor => ({
      name: called,
      segment: [...posts[0], ...posts[1]] as unknown as Segment,
      opensItself: opens === "itself",
    }),
  );
  const drawnLanes = lanes.flatMap(({ between }): PlanLane[] => {
    const [a, b] = between.map((each) => named.get(each));
    if (a === undefined || b === undefined) return [];
    const segment = [a.x, a.y, b.x, b.y] as const;
    return [{ between, segment, door: doors.find((door) => cross(segment, door.segment)) ?? null }];
  });
  const box = around([...walls, ...doors.map((door) => door.segment)], places);
  return { name, height, places, walls, lanes: drawnLanes, doors, box };
}

/** Whether two segments have a point in common. */
function cross(a: Segment, b: Segment): boolean {
  const side = ([x0, y0, x1, y1]: Segment, x: number, y: number) => Math.sign((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0));
  const apart = (one: Segment, other: Segment) => side(one, other[0], other[1]) * side(one, other[2], other[3]) > 0;
  return !apart(a, b) && !apart(b, a);
}

/** Where a place is that is called `FLOOR/PLACE`; null where the building has none. */
export function placeOf(plan: Plan, name: string): (PlanPlace & { z: number; floor: string }) | null {
  const slash = name.indexOf("/");
  const floor = plan.floors.find((each) => each.name === name.slice(0, slash));
  const place = floor?.places.find((each) => each.name === name.slice(slash + 1));
  return floor === undefined || place === undefined ? null : { ...place, z: floor.height, floor: floor.name };
}

function around(segments: readonly Segment[], places: readonly PlanPlace[]): Box {
  const box = { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
  const take = (x: number, y: number) => {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.bottom = Math.min(box.bottom, y);
    box.top = Math.max(box.top, y);
  };
  for (const [x0, y0, x1, y1] of segments) {
    take(x0, y0);
    take(x1, y1);
  }
  for (const { x, y } of places) take(x, y);
  return box.left > box.right ? { left: 0, bottom: 0, right: 1, top: 1 } : box;
}

/** Where a scene's place is; null where it has none of this name. */
export function scenePlace(scene: unknown, name: string): { x: number; y: number; z: number } | null {
  const { places } = scene as { places?: Record<string, { pose: { x: number; y: number; z?: number | null } }> };
  const pose = places?.[name]?.pose;
  return pose === undefined ? null : { x: pose.x, y: pose.y, z: pose.z ?? 0 };
}

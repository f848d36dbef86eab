// A scene file's text, with the parts, places and robots that it speaks of, each where it stands in the text.
import { isMap } from "yaml";
import { endOf, pairOf, plainOf, readYaml, startOf, type YamlSource } from "../yaml_text/source";
import { isRecord } from "../yaml_text/values";

export interface Pose {
  x: number;
  y: number;
  /** Null: on the table. */
  z: number | null;
  yaw: number;
}

export type ThingKind = "object" | "place" | "robot";

/** One thing of a scene that stands somewhere. Lengths are metres, angles radians, as in the file. */
export interface Thing {
  kind: ThingKind;
  /** What the service calls it: `bolt_2` is the second of several under `bolt`. */
  name: string;
  pose: Pose;
  /** Full extents along x, y and z: a place has those of the object that is called like it. */
  size: readonly number[] | null;
  /** Linear red, green and blue. */
  color: readonly number[] | null;
  /** The keys to what the file says of it, and of others like it; null where it says nothing. */
  owner: Owner | null;
  /** The keys to its pose in the file; null where the file says nothing of it. */
  where: readonly (string | number)[] | null;
  /** Where it stands in the text. */
  span: Span | null;
  /** Where that stands which says what it is, of itself and of others like it. */
  entry: Span | null;
  /** How many move with it: those of one grid. */
  together: number;
}

export type Owner = readonly [section: string, name: string];

export type Span = readonly [number, number];

export interface Table {
  height: number;
  center: readonly number[];
  size: readonly number[];
}

export interface SceneSource extends YamlSource {
  table: Table;
  things: readonly Thing[];
  /** Whether it is of a world of its own, as a building: what it says is not on a table then. */
  elsewhere: boolean;
}

const TABLE: Table = { height: 0.7, center: [0.7, -0.1], size: [0.7, 1.3] };
const MOST_THINGS = 1000;
const LONGEST_TEXT = 256 * 1024;

/** Read a text; null where nothing can be drawn of it. */
export function readScene(text: string): SceneSource | null {
  if (text.length > LONGEST_TEXT) return null;
  const source = readYaml(text);
  if (source === null || !isMap(source.doc.contents)) return null;
  const said = fieldsOf(source);
  const objects = entriesOf(source, "object", said.objects);
  const sizes = new Map(objects.map(({ name, size }) => [name, size]));
  const places = entriesOf(source, "place", said.places).map((place) => ({ ...place, size: sizes.get(place.name) ?? null }));
  const robots = entriesOf(source, "robot", said.robots);
  const things = [...[...places, ...objects].slice(0, MOST_THINGS), ...(robots.length === 0 ? [ALONE] : robots)];
  const elsewhere = isRecord(said.setting) && Object.keys(said.setting).length > 0;
  return { ...source, table: tableOf(said.table), things, elsewhere };
}

/** Where the file names none, one robot stands in the middle. */
const ALONE: Thing = {
  kind: "robot",
  name: "pr2",
  pose: { x: 0, y: 0, z: null, yaw: 0 },
  size: null,
  color: null,
  owner: null,
  where: null,
  span: null,
  entry: null,
  together: 1,
};

function fieldsOf(source: YamlSource): Record<string, unknown> {
  try {
    return plainOf(source, source.doc.contents) as Record<string, unknown>;
  } catch (error) {
    if (error instanceof ReferenceError) return {};
    throw error;
  }
}

function tableOf(value: unknown): Table {
  const said = isRecord(value) ? value : {};
  return {
    height: numberOf(said.height) ?? TABLE.height,
    center: numbersOf(said.center, 2) ?? TABLE.center,
    size: numbersOf(said.size, 2) ?? TABLE.size,
  };
}

/** Where in the file things of each kind are. */
export const SECTIONS: Readonly<Record<ThingKind, string>> = { object: "objects", place: "places", robot: "robots" };

function entriesOf(source: YamlSource, kind: ThingKind, entries: unknown): Thing[] {
  const section = SECTIONS[kind];
  const map = source.doc.get(section, true);
  if (!isRecord(entries) || !isMap(map)) return [];
  return Object.entries(entries).flatMap(([name, entry]) => {
    const pair = pairOf(map, name);
    if (!isRecord(entry) || pair === null) return [];
    const span: Span = [startOf(pair.key), endOf(source, pair)];
    const owner = [section, name] as const;
    const made = { kind, owner, size: numbersOf(entry.size, 3), color: numbersOf(entry.color, 3), entry: span };
    return standingsOf(source, kind, name, entry, span, [section, name]).map((each) => ({ ...made, ...each }));
  });
}

type Standing = Omit<Thing, "kind" | "owner" | "size" | "color" | "entry">;

/** Where an entry stands: once, several times, or in rows and columns. */
function standingsOf(
  source: YamlSource,
  kind: ThingKind,
  name: string,
  entry: Record<string, unknown>,
  span: Span,
  where: readonly string[],
): Standing[] {
  if (kind === "robot") return oneOf(name, entry, where, span);
  if (isRecord(entry.grid)) return gridOf(name, entry.grid, [...where, "grid", "first"], span);
  if (!Array.isArray(entry.poses)) return oneOf(name, entry.pose, [...where, "pose"], span);
  return entry.poses.flatMap((pose, index) => {
    const at = [...where, "poses", index];
    const node = source.doc.getIn(at, true);
    const own = isMap(node) ? ([startOf(node), endOf(source, node)] as const) : span;
    return oneOf(`${name}_${index + 1}`, pose, at, own);
  });
}

function oneOf(name: string, value: unknown, where: Thing["where"], span: Thing["span"]): Standing[] {
  const pose = poseOf(value);
  return pose === null ? [] : [{ name, pose, where, span, together: 1 }];
}

function gridOf(name: string, grid: Record<string, unknown>, where: Thing["where"], span: Thing["span"]): Standing[] {
  const first = poseOf(grid.first);
  const [rows, columns, step] = [numberOf(grid.rows) ?? 0, numberOf(grid.columns) ?? 0, numbersOf(grid.step, 2)];
  const count = rows * columns;
  if (first === null || step === null || !(count > 0 && count <= MOST_THINGS)) return [];
  return Array.from({ length: count }, (_, index) => {
    const [row, column] = [Math.floor(index / columns), index % columns];
    const pose = { ...first, x: first.x + row * (step[0] as number), y: first.y + column * (step[1] as number) };
    return { name: `${name}_${index + 1}`, pose, where, span, together: count };
  });
}

function poseOf(value: unknown): Pose | null {
  if (!isRecord(value)) return null;
  const [x, y] = [numberOf(value.x), numberOf(value.y)];
  return x === null || y === null ? null : { x, y, z: numberOf(value.z), yaw: numberOf(value.yaw) ?? 0 };
}

function numberOf(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

function numbersOf(value: unknown, count: number): number[] | null {
  return Array.isArray(value) && value.length === count && value.every((each) => numberOf(each) !== null) ? value : null;
}

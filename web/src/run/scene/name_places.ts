// Where names stand over the 3-D picture: each over its object, and higher up where another name
// stands there already, so that every one of them can be read.

export interface NameBox {
  readonly name: string;
  /** The middle of the object's top, in CSS pixels of the picture. */
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
  /** In the gripper: it moves, and so gives way to names that stand still. */
  readonly held: boolean;
}

export interface Area {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

export interface NamePlace {
  readonly name: string;
  /** The middle of the name's lower edge, from its object's top. */
  readonly aside: number;
  readonly above: number;
}

const ABOVE_PX = 8;
const APART_PX = 2;

/** Place the names within the picture; none on another, nor on what else lies over it (`taken`). */
export function placeNames(boxes: readonly NameBox[], picture: Area, taken: readonly Area[] = []): NamePlace[] {
  const standing = [...taken];
  return [...boxes].sort(nearestFirst).map((box) => {
    const x = within(box.x, picture.left + box.width / 2, picture.right - box.width / 2);
    const wanted = within(box.y - ABOVE_PX, picture.top + box.height, picture.bottom);
    // Up as far as there is room, and only then down.
    const lower = free(box, x, wanted, standing, -1);
    const y = lower - box.height >= picture.top ? lower : free(box, x, wanted, standing, 1);
    standing.push(areaOf(box, x, y));
    return { name: box.name, aside: x - box.x, above: box.y - y };
  });
}

function nearestFirst(a: NameBox, b: NameBox): number {
  return Number(a.held) - Number(b.held) || b.y - a.y;
}

/** The lower edge, from `y` on up (-1) or down (1), at which a name stands on nothing. */
function free(box: NameBox, x: number, y: number, standing: readonly Area[], way: -1 | 1): number {
  for (;;) {
    const mine = areaOf(box, x, y);
    const below = standing.find((each) => meet(mine, each));
    if (below === undefined) return y;
    y = way === -1 ? below.top - APART_PX : below.bottom + APART_PX + box.height;
  }
}

function areaOf({ width, height }: NameBox, x: number, y: number): Area {
  return { left: x - width / 2, right: x + width / 2, top: y - height, bottom: y };
}

function meet(a: Area, b: Area): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

function within(value: number, least: number, most: number): number {
  return Math.max(Math.min(value, most), least);
}

// Which names have room: those that matter most first, each at the first of its spots that is free.

export interface Rect {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** What is to be named: a mark of radius `clear` at (x, y), in pixels. */
export interface Named {
  readonly id: string;
  readonly x: number;
  readonly y: number;
  readonly clear: number;
  readonly width: number;
  readonly height: number;
  /** It is named even where it has no room. */
  readonly always: boolean;
  /** Where its name was before, from the mark: it stays there while that is free. */
  readonly before?: { readonly dx: number; readonly dy: number } | undefined;
}

const GAP_PX = 3;

/** The top left corner of each name that has room within bounds, by id; names come in order of what matters. */
export function placeLabels(
  named: readonly Named[],
  taken: readonly Rect[],
  bounds: Rect,
): ReadonlyMap<string, { left: number; top: number }> {
  const rects = [...taken];
  const placed = new Map<string, { left: number; top: number }>();
  for (const each of named) {
    if (!contains(bounds, { left: each.x, top: each.y, right: each.x, bottom: each.y })) continue;
    const spots = each.always
      ? spotsOf(each).map((spot) => movedWithin(spot, bounds))
      : spotsOf(each).filter((spot) => contains(bounds, spot));
    const free = spots.find((spot) => rects.every((rect) => !meet(spot, rect)));
    const spot = free ?? (each.always ? leastHidden(spots, rects) : undefined);
    if (spot === undefined) continue;
    rects.push(spot);
    placed.set(each.id, { left: spot.left, top: spot.top });
  }
  return placed;
}

/** Below first, as a name under a mark is read as its own, then above, and at the sides; the far ones last. */
function spotsOf({ x, y, clear, width, height, always, before }: Named): Rect[] {
  const at = (left: number, top: number): Rect => ({ left, top, right: left + width, bottom: top + height });
  const ring = (away: number) => [
    at(x - width / 2, y + away),
    at(x - width / 2, y - away - height),
    at(x + away, y - height / 2),
    at(x - away - width, y - height / 2),
  ];
  const near = ring(clear + GAP_PX);
  if (before !== undefined) near.unshift(at(x + before.dx, y + before.dy));
  if (!always) return near;
  const corners = [1, 2, 3].flatMap((step) => {
    const away = clear + GAP_PX + step * height * 0.75;
    const [beside, before] = [x + clear, x - clear - width];
    const [under, over] = [y + away, y - away - height];
    return [...ring(away), at(beside, under), at(beside, over), at(before, under), at(before, over)];
  });
  return [...near, ...corners];
}

function leastHidden(spots: readonly Rect[], rects: readonly Rect[]): Rect | undefined {
  const hidden = (spot: Rect) => rects.reduce((sum, rect) => sum + shared(spot, rect), 0);
  return spots.toSorted((a, b) => hidden(a) - hidden(b))[0];
}

const shared = (a: Rect, b: Rect) =>
  Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
  Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));

const meet = (a: Rect, b: Rect) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

function movedWithin(spot: Rect, bounds: Rect): Rect {
  const dx = Math.max(0, bounds.left - spot.left) - Math.max(0, spot.right - bounds.right);
  const dy = Math.max(0, bounds.top - spot.top) - Math.max(0, spot.bottom - bounds.bottom);
  return { left: spot.left + dx, top: spot.top + dy, right: spot.right + dx, bottom: spot.bottom + dy };
}

const contains = (bounds: Rect, spot: Rect) =>
  spot.left >= bounds.left && spot.top >= bounds.top && spot.right <= bounds.right && spot.bottom <= bounds.bottom;

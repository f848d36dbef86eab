import { describe, expect, it } from "vitest";
import { centred, drawnAt, fitted, moved, zoomed } from "../src/building/sight";

const BOX = { left: 10, bottom: -5, right: 50, top: 15 };
const SIZE = { width: 600, height: 400 };

describe("sight", () => {
  it("fits all of a floor, upright and undistorted, in the middle", () => {
    const sight = fitted(BOX, SIZE);
    const corner = drawnAt(sight, BOX.left, BOX.top);
    const other = drawnAt(sight, BOX.right, BOX.bottom);
    expect(corner.x).toBeGreaterThan(0);
    expect(corner.y).toBeGreaterThan(0);
    expect(corner.x + other.x).toBeCloseTo(SIZE.width);
    expect(corner.y + other.y).toBeCloseTo(SIZE.height);
    expect((other.x - corner.x) / (other.y - corner.y)).toBeCloseTo(40 / 20);
  });

  it("fits a floor that is but a point, and a view without room", () => {
    const point = { left: 2, bottom: 3, right: 2, top: 3 };
    expect(drawnAt(fitted(point, SIZE), 2, 3)).toEqual({ x: 300, y: 200 });
    expect(fitted(BOX, { width: 0, height: 0 }).scale).toBeGreaterThan(0);
  });

  it("keeps what is under the pointer where it is while it zooms", () => {
    const before = fitted(BOX, SIZE);
    const after = zoomed(before, 2, drawnAt(before, 30, 5), BOX, SIZE);
    expect(after.scale).toBeCloseTo(2 * before.scale);
    expect(drawnAt(after, 30, 5).x).toBeCloseTo(drawnAt(before, 30, 5).x);
    expect(drawnAt(after, 30, 5).y).toBeCloseTo(drawnAt(before, 30, 5).y);
  });

  it("zooms no farther than to something that can be seen", () => {
    const before = fitted(BOX, SIZE);
    expect(zoomed(before, 1e-6, { x: 0, y: 0 }, BOX, SIZE).scale).toBeGreaterThan(before.scale / 2);
    expect(zoomed(before, 1e6, { x: 0, y: 0 }, BOX, SIZE).scale).toBeLessThan(500);
  });

  it("never loses the floor from view", () => {
    const sight = moved(fitted(BOX, SIZE), 1e5, -1e5, BOX, SIZE);
    expect(drawnAt(sight, BOX.left, BOX.bottom).x).toBeLessThan(SIZE.width);
    expect(drawnAt(sight, BOX.left, BOX.bottom).y).toBeGreaterThan(0);
  });

  it("goes to a place", () => {
    expect(drawnAt(centred({ x: 12, y: 3 }, 20, SIZE), 12, 3)).toEqual({ x: 300, y: 200 });
  });
});

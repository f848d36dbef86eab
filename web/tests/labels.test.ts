import { describe, expect, it } from "vitest";
import { type Named, placeLabels } from "../src/building/labels";

const BOUNDS = { left: 0, top: 0, right: 400, bottom: 300 };
const NAME: Named = { id: "a", x: 200, y: 150, clear: 5, width: 40, height: 14, always: false };

function rectOf(named: Named, { left, top }: { left: number; top: number }) {
  return { left, top, right: left + named.width, bottom: top + named.height };
}

describe("placeLabels", () => {
  it("puts a name under its mark where there is room", () => {
    expect(placeLabels([NAME], [], BOUNDS).get("a")).toEqual({ left: 180, top: 158 });
  });

  it("puts it elsewhere where something is in the way, and leaves it out where everything is", () => {
    const below = { left: 150, top: 155, right: 250, bottom: 200 };
    expect(placeLabels([NAME], [below], BOUNDS).get("a")?.top).toBeLessThan(150);
    expect(placeLabels([NAME], [{ left: 0, top: 0, right: 400, bottom: 300 }], BOUNDS).size).toBe(0);
  });

  it("lets no two names meet, however many there are", () => {
    const crowd = Array.from({ length: 200 }, (_, index) => ({
      ...NAME,
      id: String(index),
      x: (index * 37) % 400,
      y: (index * 53) % 300,
    }));
    const placed = placeLabels(crowd, [], BOUNDS);
    expect(placed.size).toBeGreaterThan(20);
    expect(placed.size).toBeLessThan(200);
    const rects = crowd.flatMap((each) => {
      const at = placed.get(each.id);
      return at === undefined ? [] : [rectOf(each, at)];
    });
    for (const [index, a] of rects.entries()) {
      for (const b of rects.slice(index + 1)) {
        const meet = a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
        expect(meet).toBe(false);
      }
    }
  });

  it("always names a robot, within what can be seen", () => {
    const robots = [1, 2, 3].map((each) => ({ ...NAME, id: `robot${each}`, x: 399, y: 2 * each, always: true }));
    const placed = placeLabels(robots, [], BOUNDS);
    expect(placed.size).toBe(3);
    for (const { left, top } of placed.values()) {
      expect(left).toBeLessThanOrEqual(360);
      expect(top).toBeGreaterThanOrEqual(0);
    }
  });

  it("leaves a robot's name on the side on which it was while it is free", () => {
    const above = { ...NAME, always: true, before: { dx: -20, dy: -22 } };
    expect(placeLabels([above], [], BOUNDS).get("a")).toEqual({ left: 180, top: 128 });
  });
});

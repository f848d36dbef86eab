import { describe, expect, it } from "vitest";
import { type Area, type NameBox, placeNames } from "../src/run/scene/name_places";

const PICTURE: Area = { left: 0, top: 0, right: 460, bottom: 280 };

function box(name: string, x: number, y: number, held = false): NameBox {
  return { name, x, y, width: 80, height: 22, held };
}

function areas(boxes: readonly NameBox[], taken: readonly Area[] = []): Area[] {
  return placeNames(boxes, PICTURE, taken).map(({ name, aside, above }) => {
    const { x, y, width, height } = boxes.find((each) => each.name === name) as NameBox;
    const [middle, bottom] = [x + aside, y - above];
    return { left: middle - width / 2, right: middle + width / 2, top: bottom - height, bottom };
  });
}

const meet = (a: Area, b: Area) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

function pairsThatMeet(all: readonly Area[]): number {
  return all.flatMap((a, index) => all.slice(index + 1).filter((b) => meet(a, b))).length;
}

describe("the places of names", () => {
  it("is over the object where nothing else is", () => {
    expect(placeNames([box("leg", 200, 150)], PICTURE)).toEqual([{ name: "leg", aside: 0, above: 8 }]);
  });

  it("lets none stand on another, wherever the objects are", () => {
    for (let seed = 1; seed <= 200; seed++) {
      const boxes = Array.from({ length: 8 }, (_, index) => {
        const chance = Math.imul(seed * 8 + index, 0x9e3779b1) >>> 0;
        return box(String(index), chance % 460, (chance >>> 12) % 280);
      });
      const all = areas(boxes);
      expect(pairsThatMeet(all)).toBe(0);
      for (const { left, right, top } of all) {
        expect(left).toBeGreaterThanOrEqual(0);
        expect(right).toBeLessThanOrEqual(460);
        expect(top).toBeGreaterThanOrEqual(0);
      }
    }
  });

  it("keeps clear of what else lies over the picture", () => {
    const buttons = { left: 260, top: 230, right: 460, bottom: 280 };
    const [name] = areas([box("leg", 300, 270)], [buttons]);
    expect(meet(name as Area, buttons)).toBe(false);
  });

  it("moves the name of what is carried, and not that of what lies there", () => {
    const [lying, carried] = [box("lying", 200, 100), box("carried", 210, 104, true)];
    const places = new Map(placeNames([carried, lying], PICTURE).map((each) => [each.name, each]));
    expect(places.get("lying")?.above).toBe(8);
    expect(places.get("carried")?.above).toBeGreaterThan(20);
  });
});

import { describe, expect, it } from "vitest";
import { placeOf, planOf, scenePlace } from "../src/building/plan";
import { floorOn, floorShownAt, nearestPlace, whereInWords } from "../src/building/whereabouts";
import { OFFICE } from "./office_scene";

const plan = planOf(OFFICE)!;

describe("planOf", () => {
  it("finds no building in a scene that is set in none", () => {
    expect(planOf({ objects: {}, setting: {} })).toBeNull();
    expect(planOf({ objects: {} })).toBeNull();
  });

  it("has floors from the lowest to the highest, with what is left out of the file", () => {
    expect(plan.floors.map(({ name, height }) => [name, height])).toEqual([["F1", 0], ["F2", 3.5]]);
    const [first, second] = plan.floors;
    expect(first?.places.find(({ name }) => name === "hall")?.kind).toBe("waypoint");
    expect(first?.lanes).toMatchObject([
      { between: ["101", "hall"], segment: [1, 3, 1, 0], door: { name: "101" } },
      { between: ["hall", "lift"], segment: [1, 0, 5, 0], door: null },
    ]);
    expect(first?.doors).toEqual([
      { name: "101", segment: [0.5, 1.5, 1.5, 1.5], opensItself: false },
      { name: "auto", segment: [4, 1.5, 5, 1.5], opensItself: true },
    ]);
    expect(first?.box).toEqual({ left: 0, bottom: -1, right: 6, top: 3 });
    expect(second?.walls).toEqual([]);
  });

  it("says where the building's places are", () => {
    expect(placeOf(plan, "F2/204")).toMatchObject({ x: 2, y: 1, z: 3.5, floor: "F2" });
    expect(placeOf(plan, "F2/101")).toBeNull();
    expect(placeOf(plan, "hall")).toBeNull();
  });

  it("says where the scene's places are", () => {
    expect(scenePlace(OFFICE, "F2-204")).toEqual({ x: 2, y: 1, z: 3.5 });
    expect(scenePlace(OFFICE, "F1-101")).toEqual({ x: 1, y: 3, z: 0 });
    expect(scenePlace(OFFICE, "nowhere")).toBeNull();
  });
});

describe("whereabouts", () => {
  it.each([
    [{ x: 1, y: 3, z: 0 }, "on F1, at 101"],
    [{ x: 1.4, y: 0.2, z: 0.1 }, "on F1, near 101"],
    [{ x: 3, y: 2.5, z: 3.5 }, "on F2, near 204"],
    [{ x: 60, y: 2, z: 3.5 }, "on F2"],
    [{ x: 5, y: 0, z: 1.8 }, "between F1 and F2"],
    [{ x: 5, y: 0, z: 9 }, "above F2"],
    [{ x: 5, y: 0, z: -2 }, "below F1"],
  ])("of %o is in words '%s'", (at, words) => {
    expect(whereInWords(plan, at)).toBe(words);
  });

  it("names a waypoint only where nothing else is near", () => {
    const corridor = { ...plan.floors[0]!, places: [{ name: "v7", x: 0, y: 0, kind: "waypoint" as const }] };
    expect(nearestPlace(corridor, { x: 1, y: 0 })?.name).toBe("v7");
    expect(nearestPlace(corridor, { x: 50, y: 0 })).toBeNull();
  });

  it("draws who rides an elevator on the nearer floor, on which they are not", () => {
    expect(floorOn(plan, 2)).toBeNull();
    expect(floorShownAt(plan, 2).name).toBe("F2");
    expect(floorShownAt(plan, 1).name).toBe("F1");
  });
});

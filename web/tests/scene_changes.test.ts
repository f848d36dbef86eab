import fc from "fast-check";
import { describe, expect, it } from "vitest";
import { recolored, resized, without, withThing } from "../src/scenes/changed_text";
import { linearColor, screenColor } from "../src/scenes/colors";
import { moved } from "../src/scenes/moved_text";
import { freeSpot, nameFor } from "../src/scenes/new_thing";
import { readScene, type SceneSource, type Thing } from "../src/scenes/scene_source";
import { resizedTo, shownWith, turnedTo } from "../src/scenes/thing_change";
import { commentsOf } from "../src/yaml_text/source";

const BENCH = `# A bench for two.
name: bench
objects:
  # to drink from
  cup:
    color: [0.9, 0.1, 0.1]   # red
    size: [0.05, 0.06, 0.06]
    pose: {x: 0.450, y: -0.5}  # at the right
  bolt:
    color: [0.1, 0.1, 0.9]
    size: [0.014, 0.04, 0.024]
    poses:
      # the first
      - {x: 0.42, y: -0.3}
      - x: 0.50
        y: -0.3   # beside it
        yaw: 0.4
places:
  cup: {pose: {x: 0.45, y: 0.0, z: 0.75}}
  bolt:
    grid: {first: {x: 0.40, y: 0.10}, rows: 2, columns: 1, step: [0.06, 0.05]}
robots:
  left: {x: 0.0, y: 0.0}
`;

const sceneOf = (text: string) => readScene(text) as SceneSource;
const thingOf = (text: string, kind: Thing["kind"], name: string) =>
  sceneOf(text).things.find((each) => each.kind === kind && each.name === name) as Thing;
const namesOf = (text: string) => sceneOf(text).things.map(({ kind, name }) => `${kind} ${name}`);
const part = (name: string) => ({ kind: "object" as const, name, size: [0.04, 0.06, 0.05], color: [0.1, 0.3, 0.8], at: { x: 0.5, y: -0.40001 } });
const SAID = "{color: [0.1, 0.3, 0.8], size: [0.04, 0.06, 0.05], pose: {x: 0.5, y: -0.4}}";

describe("a part that is added", () => {
  it("stands after the others in a line of its own", () => {
    expect(withThing(BENCH, part("lid"))).toBe(BENCH.replace("places:\n", `  lid: ${SAID}\nplaces:\n`));
  });

  it("may be the first", () => {
    expect(withThing("name: bench\n", part("lid"))).toBe(`name: bench\nobjects:\n  lid: ${SAID}\n`);
    expect(withThing("objects: {}  # none yet\nname: bench", part("lid"))).toBe(`objects:\n  lid: ${SAID}  # none yet\nname: bench`);
    expect(withThing("objects:   # none yet\nname: bench\n", part("lid"))).toContain("# none yet");
    expect(sceneOf(withThing('{"name": "bench"}', part("lid"))).things[0]).toMatchObject({ name: "lid", pose: { x: 0.5, y: -0.4 } });
  });

  it("is told from those that are there, and may be called as words of YAML are", () => {
    expect(() => withThing(BENCH, part("cup"))).toThrow("'objects' has a 'cup' already");
    expect(namesOf(withThing(BENCH, part("null")))).toContain("object null");
    const place = withThing(BENCH, { kind: "place", name: "lid", at: { x: 0.5, y: 0.2 } });
    expect(place).toBe(BENCH.replace("robots:\n", "  lid: {pose: {x: 0.5, y: 0.2}}\nrobots:\n"));
  });
});

describe("what is taken out", () => {
  it("goes with the comments that are its own", () => {
    const text = without(BENCH, thingOf(BENCH, "object", "cup"));
    expect(commentsOf(text)).toEqual(["# A bench for two.", "# the first", "# beside it"]);
    expect(text).toBe(BENCH.slice(0, BENCH.indexOf("  # to drink")) + BENCH.slice(BENCH.indexOf("  bolt:")));
  });

  it("is one of several, and in the end the whole entry", () => {
    const one = without(BENCH, thingOf(BENCH, "object", "bolt_1"));
    expect(namesOf(one).filter((each) => each.startsWith("object"))).toEqual(["object cup", "object bolt_1"]);
    expect(thingOf(one, "object", "bolt_1").pose.x).toBe(0.5);
    const none = without(one, thingOf(one, "object", "bolt_1"));
    expect(none).not.toContain("color: [0.1, 0.1, 0.9]");
    expect(namesOf(none)).toContain("place bolt_2");
  });

  it("is a whole grid, and of the only robot the word for robots", () => {
    const text = without(BENCH, thingOf(BENCH, "place", "bolt_2"));
    expect(text).toBe(BENCH.replace(/ {2}bolt:\n {4}grid:.*\n/, ""));
    expect(without(BENCH, thingOf(BENCH, "robot", "left"))).toBe(BENCH.slice(0, BENCH.indexOf("robots:")));
    expect(() => without(BENCH, { ...thingOf(BENCH, "robot", "left"), owner: null })).toThrow("says nothing of left");
  });

  it("may be the last of its kind", () => {
    const bare = "name: bench\nobjects:\n  cup: {size: [0.05, 0.06, 0.06], pose: {x: 0.4, y: 0.0}}\n";
    const text = without(bare, thingOf(bare, "object", "cup"));
    expect(text).toBe("name: bench\nobjects: {}\n");
    expect(withThing(text, part("lid"))).toBe(`name: bench\nobjects:\n  lid: ${SAID}\n`);
  });

  it("stays where something else in the text is the same", () => {
    const text = BENCH.replace("size: [0.05", "size: &s [0.05").replace("size: [0.014, 0.04, 0.024]", "size: *s");
    expect(() => without(text, thingOf(text, "object", "cup"))).toThrow("Other things would change");
    expect(() => resized(text, thingOf(text, "object", "cup"), [0.1, 0.1, 0.1])).toThrow("Other things would change");
    expect(resized(text, thingOf(text, "object", "bolt_1"), [0.02, 0.04, 0.024])).toBe(text.replace("*s", "[0.02, 0.04, 0.024]"));
  });
});

describe("size and colour", () => {
  it("are those of all equal ones, and nothing else is written anew", () => {
    const larger = resized(BENCH, thingOf(BENCH, "object", "bolt_2"), [0.02, 0.04, 0.024]);
    expect(larger).toBe(BENCH.replace("size: [0.014,", "size: [0.02,"));
    expect(thingOf(larger, "place", "bolt_1").size).toEqual([0.02, 0.04, 0.024]);
    expect(resized(BENCH, thingOf(BENCH, "object", "cup"), [0.05, 0.06, 0.06])).toBe(BENCH);
    expect(recolored(BENCH, thingOf(BENCH, "object", "cup"), [0, 0.5, 1])).toBe(BENCH.replace("color: [0.9, 0.1, 0.1]", "color: [0, 0.5, 1]"));
  });

  it("go to the screen and back", () => {
    for (const screen of ["#000000", "#ffffff", "#e61919", "#1a2b3c"]) expect(screenColor(linearColor(screen))).toBe(screen);
    expect(screenColor(null)).toBe(screenColor([0.5, 0.5, 0.5]));
  });

  it("follow the pointer about the middle, however a part is turned", () => {
    const cup = { ...thingOf(BENCH, "object", "cup"), pose: { x: 0.4, y: 0.1, z: null, yaw: Math.PI / 2 } };
    expect(resizedTo(cup, { x: 0.45, y: 0.2 }).size).toEqual([0.2, 0.1, 0.06]);
    expect(resizedTo(cup, { x: 0.4, y: 0.1 }).size).toEqual([0.005, 0.005, 0.06]);
    expect(turnedTo(cup, { x: 0.5, y: 0.208 }, false).pose?.yaw).toBeCloseTo((45 * Math.PI) / 180);
    expect(turnedTo(cup, { x: 0.5, y: 0.208 }, true).pose?.yaw).toBeCloseTo((47 * Math.PI) / 180);
    expect(turnedTo({ ...cup, kind: "robot" }, { x: 0.5, y: 0.5 }, true).pose?.yaw).toBeCloseTo(Math.PI / 2);
    const bolt = (name: string) => thingOf(BENCH, "object", name);
    expect(shownWith(bolt("bolt_1"), bolt("bolt_2"), { size: [1, 1, 1], pose: { x: 0.6 } })).toMatchObject({ size: [1, 1, 1], pose: { x: 0.42 } });
    const place = (name: string) => thingOf(BENCH, "place", name);
    expect(shownWith(place("bolt_1"), place("bolt_2"), { pose: { y: 0.2, yaw: 1 } }).pose).toMatchObject({ x: 0.4, y: expect.closeTo(0.2), yaw: 1 });
  });
});

describe("a new thing", () => {
  it("has a name that is free: a place that of a part without one", () => {
    const cup = thingOf(BENCH, "object", "cup");
    expect(nameFor("object", sceneOf(withThing(BENCH, part("part_1"))), cup)).toBe("part_2");
    expect(nameFor("place", sceneOf(withThing(BENCH, part("lid"))), cup)).toBe("lid");
    expect(nameFor("place", sceneOf(BENCH), cup)).toBe("place_1");
  });

  it("comes where there is room and a robot reaches", () => {
    const source = sceneOf(BENCH);
    const reach = [{ robot: "left", x: 0, y: 0, min_m: 0.5, max_m: 0.6 }];
    const spot = freeSpot("object", [0.04, 0.06, 0.05], source, reach, { x: 0.45, y: -0.5 });
    expect(Math.hypot(spot.x, spot.y)).toBeGreaterThanOrEqual(0.5);
    expect(Math.hypot(spot.x, spot.y)).toBeLessThanOrEqual(0.6);
    for (const { pose } of source.things.filter(({ kind }) => kind === "object")) {
      expect(Math.hypot(spot.x - pose.x, spot.y - pose.y)).toBeGreaterThan(0.05);
    }
    expect(freeSpot("object", [2, 2, 2], source, [], { x: 0, y: 0 })).toEqual({ x: 0.7, y: -0.1 });
  });
});

const metres = fc.integer({ min: -900, max: 900 }).map((each) => each / 1000);
const extent = fc.integer({ min: 5, max: 400 }).map((each) => each / 1000);
const deed = fc.oneof(
  fc.record({ does: fc.constant("add" as const), name: fc.constantFrom("a", "b", "on", "null", "x-1"), x: metres, y: metres }),
  fc.record({ does: fc.constant("remove" as const), index: fc.nat(8) }),
  fc.record({ does: fc.constant("resize" as const), index: fc.nat(8), size: fc.tuple(extent, extent, extent) }),
  fc.record({ does: fc.constant("move" as const), index: fc.nat(8), x: metres, y: metres }),
);

describe("a scene that is changed at random", () => {
  it("says what was done and keeps all else, with every comment of what stays", () => {
    fc.assert(
      fc.property(fc.array(deed, { maxLength: 8 }), (deeds) => {
        let text = BENCH;
        for (const each of deeds) {
          const before = sceneOf(text).things.filter(({ where }) => where !== null);
          if (each.does === "add") {
            if (before.some(({ kind, name }) => kind === "object" && name === each.name)) continue;
            text = withThing(text, { ...part(each.name), at: each });
            expect(thingOf(text, "object", each.name).pose).toEqual({ x: each.x, y: each.y, z: null, yaw: 0 });
            continue;
          }
          const thing = before[each.index];
          if (thing === undefined) continue;
          if (each.does === "remove") {
            text = without(text, thing);
            const left = sceneOf(text).things.filter(({ where }) => where !== null);
            expect(left).toHaveLength(before.length - thing.together);
          } else if (each.does === "move") text = moved(text, thing, { x: each.x });
          else if (thing.kind === "object") {
            text = resized(text, thing, each.size);
            expect(thingOf(text, "object", thing.name).size).toEqual(each.size);
          }
        }
        expect(commentsOf(text)).toContain("# A bench for two.");
        const cup = sceneOf(text).things.some(({ kind, name }) => kind === "object" && name === "cup");
        expect(commentsOf(text).includes("# red")).toBe(cup);
      }),
      { numRuns: 60, seed: 4 },
    );
  });
});

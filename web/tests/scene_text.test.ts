import fc from "fast-check";
import { describe, expect, it } from "vitest";
import type { Checked } from "../src/document/checked";
import { moved, wrapped } from "../src/scenes/moved_text";
import { sceneActionOf } from "../src/scenes/scene_keys";
import { readScene, type SceneSource, type Thing } from "../src/scenes/scene_source";
import { thingProblems } from "../src/scenes/thing_problems";
import { viewFrame } from "../src/scenes/view_frame";
import { commentsOf } from "../src/yaml_text/source";

const BENCH = `# A bench for two.
name: bench
objects:
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

describe("a scene's text", () => {
  it("has every part, place and robot at its pose, several of one entry under numbers", () => {
    const { things, table } = sceneOf(BENCH);
    expect(things.map(({ kind, name }) => `${kind} ${name}`)).toEqual([
      "place cup",
      "place bolt_1",
      "place bolt_2",
      "object cup",
      "object bolt_1",
      "object bolt_2",
      "robot left",
    ]);
    expect(table).toEqual({ height: 0.7, center: [0.7, -0.1], size: [0.7, 1.3] });
    expect(thingOf(BENCH, "object", "bolt_2").pose).toEqual({ x: 0.5, y: -0.3, z: null, yaw: 0.4 });
    const place = thingOf(BENCH, "place", "bolt_2");
    expect(place).toMatchObject({ size: [0.014, 0.04, 0.024], together: 2 });
    expect(place.pose.x).toBeCloseTo(0.46);
  });

  it("has one robot in the middle where it names none, which cannot be moved", () => {
    const text = BENCH.slice(0, BENCH.indexOf("robots:"));
    const robot = thingOf(text, "robot", "pr2");
    expect(robot.pose).toEqual({ x: 0, y: 0, z: null, yaw: 0 });
    expect(() => moved(text, robot, { x: 1 })).toThrow("add it to 'robots'");
  });

  it("changes in the numbers of what was moved alone", () => {
    expect(moved(BENCH, thingOf(BENCH, "object", "cup"), { x: 0.45, y: -0.41234567 })).toBe(
      BENCH.replace("{x: 0.450, y: -0.5}", "{x: 0.450, y: -0.4123}"),
    );
    expect(moved(BENCH, thingOf(BENCH, "object", "bolt_2"), { yaw: -0.1 })).toBe(BENCH.replace("yaw: 0.4", "yaw: -0.1"));
    expect(moved(BENCH, thingOf(BENCH, "object", "bolt_1"), { yaw: 0.2 })).toBe(
      BENCH.replace("{x: 0.42, y: -0.3}", "{x: 0.42, y: -0.3, yaw: 0.2}"),
    );
    expect(moved(BENCH, thingOf(BENCH, "place", "bolt_2"), { x: 0.5 })).toBe(BENCH.replace("first: {x: 0.40,", "first: {x: 0.5,"));
    expect(moved(BENCH, thingOf(BENCH, "place", "cup"), { z: null })).toBe(BENCH.replace(", z: 0.75", ""));
    expect(moved(BENCH, thingOf(BENCH, "robot", "left"), { yaw: Math.PI / 2 })).toBe(
      BENCH.replace("left: {x: 0.0, y: 0.0}", "left: {x: 0.0, y: 0.0, yaw: 1.5708}"),
    );
  });

  it("keeps every comment and says every pose, whatever is moved", () => {
    const metres = fc.integer({ min: -2000, max: 2000 }).map((each) => each / 1000);
    const move = fc.record({ index: fc.nat(6), x: metres, y: metres, yaw: fc.integer({ min: -314, max: 314 }).map((each) => each / 100) });
    fc.assert(
      fc.property(fc.array(move, { maxLength: 6 }), (moves) => {
        let text = BENCH;
        for (const { index, ...to } of moves) {
          const thing = sceneOf(text).things[index] as Thing;
          text = moved(text, thing, to);
          const first = sceneOf(text).things.find(({ where }) => where?.join() === thing.where?.join());
          expect(first?.pose).toMatchObject(to);
        }
        expect(commentsOf(text)).toEqual(commentsOf(BENCH));
        expect(text.split("\n")).toHaveLength(BENCH.split("\n").length + addedLines(text));
      }),
      { numRuns: 20, seed: 3 },
    );
  });
});

/** A pose in lines gets one for a key that it did not have. */
function addedLines(text: string): number {
  return text.split("\n").filter((line) => /^ {8}(?:z|yaw):/.test(line)).length - 1;
}

describe("problems of a scene", () => {
  const checked = (errors: { line: number; message: string }[], worlds: unknown[] = []): Checked =>
    ({ check: { name: null, definition: null, errors, worlds }, text: BENCH }) as unknown as Checked;

  it("are at what their line is of, and of several at those that they name", () => {
    const lineOf = (part: string) => BENCH.slice(0, BENCH.indexOf(part)).split("\n").length;
    const found = thingProblems(
      sceneOf(BENCH),
      checked([
        { line: lineOf("cup:"), message: "cup starts in the air" },
        { line: lineOf("poses:"), message: "bolt_2 is too narrow" },
        { line: lineOf("grid:"), message: "the arm does not reach it" },
      ]),
    );
    expect([...found.keys()]).toEqual(["object:cup", "object:bolt_2", "place:bolt_1", "place:bolt_2"]);
  });

  it("of one world alone are no mistakes", () => {
    const worlds = [{ world: "workcell", problems: [{ line: 4, message: "cup is far" }], reach: [] }];
    expect(thingProblems(sceneOf(BENCH), checked([], worlds)).get("object:cup")).toEqual([
      { message: "in the world 'workcell': cup is far", mistake: false },
    ]);
  });

  it("go with what was moved since", () => {
    const text = moved(BENCH, thingOf(BENCH, "object", "cup"), { x: 0.5 });
    const told = checked([{ line: 4, message: "cup is far" }, { line: 13, message: "bolt_1 is far" }]);
    expect([...thingProblems(sceneOf(text), told).keys()]).toEqual(["object:bolt_1"]);
  });
});

describe("the view from above", () => {
  it("has forward up and left left, and goes back to metres", () => {
    const frame = viewFrame(sceneOf(BENCH), 700, 500);
    expect(frame.top(0.5)).toBeLessThan(frame.top(0.2));
    expect(frame.left(0.5)).toBeLessThan(frame.left(-0.5));
    expect([frame.width <= 700, frame.height <= 500.001]).toEqual([true, true]);
    const { x, y } = frame.at(frame.left(-0.3), frame.top(0.4));
    expect([x, y]).toEqual([expect.closeTo(0.4), expect.closeTo(-0.3)]);
  });

  it("takes keys for steps and turns, a robot by quarters", () => {
    const thing = (kind: Thing["kind"]) => ({ kind, pose: { x: 0.4, y: 0.1, z: null, yaw: 0 }, size: [0.05, 0.06, 0.07] }) as unknown as Thing;
    const part = thing("object");
    const key = (name: string, shiftKey = false) => ({ key: name, shiftKey, altKey: false, ctrlKey: false, metaKey: false });
    expect(sceneActionOf(key("ArrowUp"), part)).toEqual({ change: { pose: { x: expect.closeTo(0.41) } } });
    expect(sceneActionOf(key("ArrowRight", true), part)).toEqual({ change: { pose: { y: expect.closeTo(0.099) } } });
    expect(sceneActionOf(key("q"), part)).toEqual({ change: { pose: { yaw: expect.closeTo(Math.PI / 36) } } });
    expect(sceneActionOf(key("E", true), thing("robot"))).toEqual({ change: { pose: { yaw: expect.closeTo(-Math.PI / 2) } } });
    expect(sceneActionOf(key("PageDown"), part)).toEqual({ go: "next" });
    const alt = (name: string, shiftKey = false) => ({ ...key(name, shiftKey), altKey: true });
    expect(sceneActionOf(alt("ArrowUp"), part)).toEqual({ change: { size: [expect.closeTo(0.055), 0.06, 0.07] } });
    expect(sceneActionOf(alt("ArrowLeft", true), part)).toEqual({ change: { size: [0.05, expect.closeTo(0.059), 0.07] } });
    expect(sceneActionOf(alt("ArrowUp"), thing("place"))).toBeNull();
    expect(sceneActionOf({ ...key("n"), ctrlKey: true }, part)).toBeNull();
    expect(sceneActionOf(key("n"), part)).toEqual({ does: "add" });
    expect(sceneActionOf(key("Delete"), part)).toEqual({ does: "remove" });
    expect(wrapped((3 * Math.PI) / 2)).toBeCloseTo(-Math.PI / 2);
  });
});

import { describe, expect, it } from "vitest";
import { decodeFrame, decodeFrames } from "../src/run/scene/decode";
import { frameBytes } from "./frame_bytes";

describe("decodeFrame", () => {
  it("reads every field where the service writes it", () => {
    const frame = decodeFrame(
      frameBytes({ time: 12.5, number: 7, joints: [0.25, -1.5], opening: 0.0625, objects: [{ x: 0.5, flags: 5 }] }),
    );
    expect(frame.time).toBe(12.5);
    expect(frame.number).toBe(7);
    expect([...frame.joints]).toEqual([0.25, -1.5]);
    expect([...frame.base]).toEqual([0, 0, 0, 0, 0, 0, 1]);
    expect([...frame.tool]).toEqual([0.5, -0.25, 0.75, 0, 0, 0, 1]);
    expect(frame.opening).toBe(0.0625);
    expect(frame.objects).toHaveLength(1);
    expect(frame.objects[0]).toMatchObject({ held: true, gone: false, hidden: true });
    expect(frame.objects[0]?.pose[0]).toBe(0.5);
    expect(frame.robots).toEqual([]);
  });

  it("reads where the robots are that drive, after everything else", () => {
    const robots = [{ x: 2, z: 3.5, age: 0.25 }, { age: Infinity }];
    const frame = decodeFrame(frameBytes({ joints: [1], objects: [{}], robots }));
    expect(frame.robots.map(({ age }) => age)).toEqual([0.25, Infinity]);
    expect([...frame.robots[0]!.pose]).toEqual([2, 0, 3.5, 0, 0, 0, 1]);
  });

  it("reads the arms of other robots at the end, with and without bases before them", () => {
    const arms = [{ number: 2, x: 1.5, joints: [0.5, -0.5], opening: 0.0625, age: 0.25 }, { number: 0 }];
    for (const robots of [[], [{ x: 2 }]]) {
      const frame = decodeFrame(frameBytes({ joints: [1], objects: [{}], robots, arms }));
      expect(frame.robots).toHaveLength(robots.length);
      const [first, second] = frame.arms;
      expect(first).toMatchObject({ number: 2, opening: 0.0625, age: 0.25 });
      expect([...first!.joints]).toEqual([0.5, -0.5]);
      expect(first!.base[0]).toBe(1.5);
      expect([...first!.tool]).toEqual([0.25, 0, 0.75, 0, 0, 0, 1]);
      expect([second!.number, second!.joints.length]).toEqual([0, 0]);
    }
    expect(decodeFrame(frameBytes({})).arms).toEqual([]);
  });

  it("refuses what is shorter or longer than it says", () => {
    const bytes = frameBytes({ joints: [0], objects: [{}] });
    expect(() => decodeFrame(bytes.slice(0, 40))).toThrow(RangeError);
    expect(() => decodeFrame(bytes.slice(0, bytes.byteLength - 4))).toThrow("has 112 bytes and 32 a robot, not 108");
  });
});

describe("decodeFrames", () => {
  it("reads frames at any offset, and leaves out a torn one", () => {
    const one = new Uint8Array(frameBytes({ time: 1, joints: [1] }));
    const two = new Uint8Array(frameBytes({ time: 2, joints: [] }));
    const bytes = new Uint8Array(8 + one.length + two.length + 10);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, one.length, true);
    bytes.set(one, 4);
    view.setUint32(4 + one.length, two.length, true);
    bytes.set(two, 8 + one.length);
    view.setUint32(8 + one.length + two.length, 76, true);
    expect(decodeFrames(bytes.buffer).map((each) => each.time)).toEqual([1, 2]);
  });

  it("finds nothing in nothing", () => {
    expect(decodeFrames(new ArrayBuffer(0))).toEqual([]);
  });
});

import { describe, expect, it } from "vitest";
import { decodeFrame, type Frame } from "../src/run/scene/decode";
import { between, createPoseBuffer, slerp } from "../src/run/scene/interpolate";
import { frameBytes } from "./frame_bytes";

function frame(time: number, x: number, more: { flags?: number; joint?: number; yaw?: number } = {}): Frame {
  const { flags = 0, joint = 0, yaw = 0 } = more;
  return decodeFrame(frameBytes({ time, joints: [joint], objects: [{ x, flags, yaw }] }));
}

const xOf = (shown: Frame | null) => shown?.objects[0]?.pose[0] ?? Number.NaN;

describe("between", () => {
  it("is in the middle half-way", () => {
    const half = between(frame(1, 0.1, { joint: 0.2 }), frame(2, 0.2, { joint: 0.4 }), 0.5);
    expect(xOf(half)).toBeCloseTo(0.15);
    expect(half.joints[0]).toBeCloseTo(0.3);
    expect(half.time).toBeCloseTo(1.5);
  });

  it("never goes past either end", () => {
    expect(xOf(between(frame(1, 0.1), frame(2, 0.2), 1.7))).toBeCloseTo(0.2);
    expect(xOf(between(frame(1, 0.1), frame(2, 0.2), -3))).toBeCloseTo(0.1);
  });

  it("lets what was carried off by a hand jump", () => {
    expect(xOf(between(frame(1, 0.1), frame(2, 0.9), 0.9))).toBeCloseTo(0.1);
  });

  it("lets what vanishes stay where it was until then", () => {
    const almost = between(frame(1, 0.1), frame(2, 0.12, { flags: 2 }), 0.99);
    expect(almost.objects[0]?.gone).toBe(false);
    expect(xOf(almost)).toBeCloseTo(0.1);
  });

  it("moves every arm, and mixes none with another", () => {
    const armed = (time: number, number: number, angle: number) => decodeFrame(frameBytes({ time, arms: [{ number, joints: [angle], x: angle / 10 }] }));
    const [half] = between(armed(1, 0, 0.2), armed(2, 0, 0.4), 0.5).arms;
    expect(half?.joints[0]).toBeCloseTo(0.3);
    expect(half?.base[0]).toBeCloseTo(0.03);
    expect(between(armed(1, 0, 0.2), armed(2, 1, 0.4), 0.5).arms[0]?.joints[0]).toBeCloseTo(0.2);
  });

  it("does not mix frames of different worlds", () => {
    const other = decodeFrame(frameBytes({ time: 2, joints: [] }));
    expect(between(frame(1, 0.1), other, 0.5).objects).toHaveLength(1);
  });
});

describe("slerp", () => {
  const turn = (angle: number) => [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];

  it("turns evenly", () => {
    const third = slerp(turn(0), turn(0.9), 1 / 3);
    expect(2 * Math.atan2(third[2], third[3])).toBeCloseTo(0.3);
  });

  it("takes the shorter way between a rotation and another's negative", () => {
    const half = slerp(turn(0.2), turn(0.4).map((value) => -value), 0.5);
    expect(Math.abs(half[2] / half[3])).toBeCloseTo(Math.tan(0.15));
  });

  it("stays a rotation where the two are the same", () => {
    expect(Math.hypot(...slerp(turn(1), turn(1), 0.3))).toBeCloseTo(1);
  });
});

describe("pose buffer", () => {
  it("shows nothing before the first frame, and that one at once", () => {
    const buffer = createPoseBuffer(100);
    expect(buffer.at(0)).toBeNull();
    buffer.push(frame(1, 0.1), 1000);
    expect(xOf(buffer.at(1000))).toBeCloseTo(0.1);
  });

  it("moves evenly though frames come unevenly", () => {
    const buffer = createPoseBuffer(100);
    const late = [0, 22, 3, 18, 0, 25, 9, 4, 20, 0];
    let longest = 0;
    let last = 0;
    for (let now = 0; now < 600; now += 10) {
      for (const [index, by] of late.entries()) {
        if (now === Math.ceil((50 * index + by) / 10) * 10) buffer.push(frame(index / 20, index * 0.01), now);
      }
      const x = xOf(buffer.at(now));
      if (now > 200 && now < 500) {
        expect(x).toBeGreaterThanOrEqual(last);
        longest = Math.max(longest, x - last);
      }
      last = x;
    }
    // The true speed is 0.002 per 10 ms.
    expect(longest).toBeLessThan(0.005);
    expect(last).toBeCloseTo(0.09);
  });

  it("holds still through a pause instead of creeping through it", () => {
    const buffer = createPoseBuffer(100);
    buffer.push(frame(1, 0.1), 1000);
    buffer.push(frame(4, 0.2), 4000);
    expect(xOf(buffer.at(3900))).toBeCloseTo(0.1);
    expect(xOf(buffer.at(4070))).toBeGreaterThan(0.1);
    expect(xOf(buffer.at(4100))).toBeCloseTo(0.2);
  });

  it("says when there is nothing more to show", () => {
    const buffer = createPoseBuffer(100);
    buffer.push(frame(1, 0.1), 1000);
    buffer.push(frame(1.05, 0.2), 1050);
    expect(buffer.moving(1100)).toBe(true);
    expect(buffer.moving(1151)).toBe(false);
    expect(xOf(buffer.at(1151))).toBeCloseTo(0.2);
  });

  it("begins anew when the run's clock goes back", () => {
    const buffer = createPoseBuffer(100);
    buffer.push(frame(9, 0.9), 1000);
    buffer.push(frame(2, 0.2), 1050);
    expect(xOf(buffer.at(1060))).toBeCloseTo(0.2);
  });
});

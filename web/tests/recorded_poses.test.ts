import { describe, expect, it } from "vitest";
import { decodeFrame, type Frame } from "../src/run/scene/decode";
import { createRecordedPoses } from "../src/run/scene/recorded_poses";
import { frameBytes } from "./frame_bytes";

function recording(times: number[], ended = true) {
  const asked: number[] = [];
  const frames = times.map((time) => decodeFrame(frameBytes({ time, objects: [{ x: time / 100 }] })));
  const poses = createRecordedPoses(
    (from, to) => {
      asked.push(from);
      const recorded = frames.length > 0 ? ([frames[0]?.time, frames.at(-1)?.time] as [number, number]) : null;
      return Promise.resolve({ frames: frames.filter(({ time }) => time >= from && time <= to), recorded });
    },
    () => ended,
  );
  const add = (time: number) => frames.push(decodeFrame(frameBytes({ time, objects: [{ x: time / 100 }] })));
  return { poses, asked, add };
}

const xOf = (frame: Frame | null) => frame?.objects[0]?.pose[0];

describe("recorded poses", () => {
  it("are null when nothing is recorded", async () => {
    expect(await recording([]).poses.at(3)).toBeNull();
  });

  it("are interpolated between the frames around the time", async () => {
    expect(xOf(await recording([0, 2, 4]).poses.at(3))).toBeCloseTo(0.03);
  });

  it("hold the last frame through spans without any", async () => {
    expect(xOf(await recording([1, 2, 100]).poses.at(95))).toBeCloseTo(0.02);
    expect(xOf(await recording([1, 2]).poses.at(95))).toBeCloseTo(0.02);
  });

  it("begin with the first frame", async () => {
    expect(xOf(await recording([5, 6]).poses.at(1))).toBeCloseTo(0.05);
  });

  it("are read once a span", async () => {
    const { poses, asked } = recording([0, 1, 2, 3]);
    await Promise.all([poses.at(1), poses.at(2)]);
    await poses.at(3);
    expect(asked).toEqual([0]);
  });

  it("are read again while the run still adds to the span", async () => {
    const { poses, add } = recording([0, 1], false);
    await poses.at(1);
    add(2);
    expect(xOf(await poses.at(2))).toBeCloseTo(0.02);
  });
});

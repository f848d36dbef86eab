// The numbers in the recorded poses of a run: how far its gripper is open, its joints, where its tool and its bases are.
import { plain, withoutRun } from "../../tree/words";
import * as rest from "../../wire/rest";
import type { Layout } from "../../wire/types";
import { type ArmPose, decodeFrames, type Frame } from "../scene/decode";
import type { Point, Series } from "./series";
import { t } from "../../words/words";

/** Frames are told by the millisecond in the address of the next ones. */
const NEXT_S = 0.001;

export interface PoseNumber {
  readonly id: string;
  readonly name: string;
  readonly unit: string;
  /** What it is in a frame; null where the frame does not tell. */
  of(frame: Frame): number | null;
}

const AXES = ["x", "y", "z"] as const;

/** The numbers that frames of a layout hold. */
export function numbersIn(layout: Layout): PoseNumber[] {
  const placed = (id: string, name: string, poseOf: (frame: Frame) => Float32Array | null): PoseNumber[] =>
    AXES.map((axis, index) => ({
      id: `${id}/${axis}`,
      name: `${name}, ${axis}`,
      unit: "m",
      of: (frame) => poseOf(frame)?.[index] ?? null,
    }));
  const held = (id: string, of: string, joints: readonly string[], armOf: (frame: Frame) => ArmPose | null): PoseNumber[] => [
    { id: `${id}/opening`, name: t("gripper{of}: opening", { of }), unit: "m", of: (frame) => armOf(frame)?.opening ?? null },
    ...placed(`${id}/tool`, `tool${of}`, (frame) => armOf(frame)?.tool ?? null),
    ...joints.map((joint, index) => ({
      id: `${id}/joint/${joint}`,
      name: `joint${of}: ${plain(joint)}`,
      unit: "rad",
      of: (frame: Frame) => armOf(frame)?.joints[index] ?? null,
    })),
  ];
  const of = (robot: string) => (layout.arms.length > 0 ? ` ${t("of {robot}", { robot: withoutRun(robot) })}` : "");
  return [
    ...held("poses", of(layout.robot), layout.joints, (frame) => frame),
    ...layout.arms.flatMap(({ robot, joints }, number) =>
      held(`poses/${robot}`, of(robot), joints, (frame) => frame.arms.find((each) => each.number === number) ?? null),
    ),
    ...layout.robots.flatMap((robot, index) =>
      placed(`poses/base/${robot}`, t("base of {robot}", { robot: withoutRun(robot) }), (frame) => {
        const base = frame.robots[index];
        return base === undefined || !Number.isFinite(base.age) ? null : base.pose;
      }),
    ),
  ];
}

/** A number over the frames that hold it. */
export function seriesOf(number: PoseNumber, frames: readonly Frame[]): Series {
  const points: Point[] = [];
  for (const frame of frames) {
    const value = number.of(frame);
    if (value !== null && Number.isFinite(value)) points.push({ time: frame.time, value, seq: null });
  }
  return { id: number.id, name: number.name, unit: number.unit, points };
}

export interface PoseNumbers {
  readonly numbers: readonly PoseNumber[];
  /** The frames that are read. */
  frames(): readonly Frame[];
  /** Read what was recorded since; whether there was any. */
  readOn(): Promise<boolean>;
}

/** What was recorded of a run; null where nothing was. */
export async function openPoseNumbers(run: string): Promise<PoseNumbers | null> {
  const layout = await rest.layout(run).catch((error: unknown) => {
    if (error instanceof rest.Refusal && error.status === 404) return null;
    throw error;
  });
  if (layout === null) return null;
  const frames: Frame[] = [];
  return {
    numbers: numbersIn(layout),
    frames: () => frames,
    async readOn() {
      const last = frames.at(-1);
      const { bytes } = await rest.poses(run, last === undefined ? 0 : last.time + NEXT_S, FOREVER_S);
      const more = decodeFrames(bytes);
      frames.push(...more);
      return more.length > 0;
    },
  };
}

const FOREVER_S = 1e9;

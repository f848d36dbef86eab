// What lies between two frames, and when to show it: a little behind what has come, so that there
// nearly always is a frame on both sides.
import type { ArmPose, Frame, PoseValues, ShownArm, ShownBase, ShownObject } from "./decode";

export const DELAY_MS = 100;

// Nothing comes while nothing moves: after such a pause the old frame holds until just before the new one.
const PAUSE_MS = 250;
const USUAL_INTERVAL_MS = 60;
const MOST_WAITING = 64;

// More than this from one frame to the next is somebody's hand or another world, not a motion.
const JUMP_M = 0.15;
const JUMP_RAD = 0.8;
// Robots that drive go so far between two frames at the most, where the clock is fast.
const DRIVE_JUMP_M = 5;
// Where nothing came for longer a robot may have gone anywhere in between.
const DRIVE_GAP_S = 2;

interface Stamped {
  readonly at: number;
  readonly frame: Frame;
}

export interface PoseBuffer {
  /** Take a frame that came at `now` (milliseconds of this page). */
  push(frame: Frame, now: number): void;
  /** What to show at `now`; null before the first frame. */
  at(now: number): Frame | null;
  /** Whether what is shown can still change after `now` without another frame. */
  moving(now: number): boolean;
  clear(): void;
}

export function createPoseBuffer(delay = DELAY_MS): PoseBuffer {
  let waiting: Stamped[] = [];
  return {
    push(frame, now) {
      const last = waiting.at(-1);
      if (last !== undefined && frame.time < last.frame.time) waiting = [];
      else if (last !== undefined) {
        if (now - last.at > PAUSE_MS) waiting.push({ at: now - USUAL_INTERVAL_MS, frame: last.frame });
      }
      waiting.push({ at: stamp(waiting.at(-1), frame, now), frame });
      if (waiting.length > MOST_WAITING) waiting = waiting.slice(-MOST_WAITING);
    },
    at(now) {
      const shown = now - delay;
      while (waiting.length > 1 && (waiting[1] as Stamped).at <= shown) waiting.shift();
      const [before, after] = waiting;
      if (before === undefined) return null;
      if (after === undefined || shown <= before.at) return before.frame;
      return between(before.frame, after.frame, (shown - before.at) / (after.at - before.at));
    },
    moving: (now) => waiting.length > 0 && now - delay <= (waiting.at(-1) as Stamped).at,
    clear() {
      waiting = [];
    },
  };
}

/** When a frame counts as come: the network bunches frames, so the even beat is half believed. */
function stamp(last: Stamped | undefined, frame: Frame, now: number): number {
  if (last === undefined) return now;
  const beat = last.at + Math.min(1000 * (frame.time - last.frame.time), 2 * USUAL_INTERVAL_MS);
  const even = beat + (now - beat) / 2;
  // Never later than it came, which would let the delay grow, and never before the frame before it.
  return Math.max(Math.min(even, now), last.at + 1);
}

/** The moment at `share` (0 to 1) of the way from one frame to the next. */
export function between(from: Frame, to: Frame, share: number): Frame {
  const part = Math.min(Math.max(share, 0), 1);
  if (part === 0 || from === to || !alike(from, to)) return part < 1 ? from : to;
  if (part === 1) return to;
  return {
    time: mix(from.time, to.time, part),
    number: from.number,
    base: mixPoses(from.base, to.base, part),
    ...mixArmPoses(from, to, part),
    objects: from.objects.map((each, index) => mixObjects(each, to.objects[index] as ShownObject, part)),
    robots: from.robots.map((each, index) => mixRobots(each, to.robots[index] as ShownBase, part, to.time - from.time)),
    arms: from.arms.map((each, index) => mixArms(each, to.arms[index] as ShownArm, part)),
  };
}

function mixArmPoses(from: ArmPose, to: ArmPose, share: number): ArmPose {
  return {
    joints: mixJoints(from.joints, to.joints, share),
    tool: mixPoses(from.tool, to.tool, share),
    opening: mix(from.opening, to.opening, share),
  };
}

function mixArms(from: ShownArm, to: ShownArm, share: number): ShownArm {
  const { number } = from;
  const [base, age] = [mixPoses(from.base, to.base, share), mix(from.age, to.age, share)];
  return { number, base, age, ...mixArmPoses(from, to, share) };
}

function alike(from: Frame, to: Frame): boolean {
  return (
    from.joints.length === to.joints.length &&
    from.objects.length === to.objects.length &&
    from.robots.length === to.robots.length &&
    from.arms.length === to.arms.length &&
    from.arms.every((each, index) => {
      const then = to.arms[index] as ShownArm;
      return each.number === then.number && each.joints.length === then.joints.length;
    })
  );
}

function mixRobots(from: ShownBase, to: ShownBase, share: number, gap: number): ShownBase {
  if (from.age === Infinity || to.age === Infinity) return from;
  if (gap > DRIVE_GAP_S) return { pose: from.pose, age: from.age + share * gap };
  return { pose: mixPoses(from.pose, to.pose, share, DRIVE_JUMP_M), age: mix(from.age, to.age, share) };
}

function mixObjects(from: ShownObject, to: ShownObject, share: number): ShownObject {
  // What appears or vanishes does so at its own frame; in between it has no way to go.
  if (from.gone !== to.gone || from.hidden !== to.hidden) return from;
  return { ...from, pose: mixPoses(from.pose, to.pose, share) };
}

function mixJoints(from: Float32Array, to: Float32Array, share: number): Float32Array {
  return from.map((angle, index) => {
    const next = to[index] as number;
    return Math.abs(next - angle) > JUMP_RAD ? angle : mix(angle, next, share);
  });
}

function mixPoses(from: PoseValues, to: PoseValues, share: number, jump = JUMP_M): PoseValues {
  const [x0, y0, z0] = from as unknown as [number, number, number];
  const [x1, y1, z1] = to as unknown as [number, number, number];
  if (Math.hypot(x1 - x0, y1 - y0, z1 - z0) > jump) return from;
  const turned = slerp(from.subarray(3), to.subarray(3), share);
  return Float32Array.of(mix(x0, x1, share), mix(y0, y1, share), mix(z0, z1, share), ...turned);
}

const mix = (from: number, to: number, share: number) => from + (to - from) * share;

/** The rotation at `share` of the shorter way between two. */
export function slerp(from: ArrayLike<number>, to: ArrayLike<number>, share: number): [number, number, number, number] {
  const a = Array.from(from) as [number, number, number, number];
  const b = Array.from(to) as [number, number, number, number];
  const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  // A quaternion and its negative are the same rotation; one of the two is nearer.
  const sign = dot < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(Math.abs(dot), 1));
  const sine = Math.sin(angle);
  const [wa, wb] =
    sine < 1e-5 ? [1 - share, share] : [Math.sin((1 - share) * angle) / sine, Math.sin(share * angle) / sine];
  const mixed = a.map((value, index) => wa * value + wb * sign * (b[index] as number));
  const norm = Math.hypot(...mixed) || 1;
  return mixed.map((value) => value / norm) as [number, number, number, number];
}

// The binary frames of poses, as docs/console_api.md lays them out.

/** x, y, z and the quaternion's x, y, z, w. */
export type PoseValues = Float32Array;

export interface ShownObject {
  readonly pose: PoseValues;
  readonly held: boolean;
  readonly gone: boolean;
  readonly hidden: boolean;
}

/** Where a robot's base frame is in the scene's. */
export interface ShownBase {
  /** z is the height of its floor. */
  readonly pose: PoseValues;
  /** How old that is, in seconds of the run's clock; infinite where it has not been said. */
  readonly age: number;
}

/** How an arm is held. */
export interface ArmPose {
  /** Radians, in the order of the layout's joints. */
  readonly joints: Float32Array;
  readonly tool: PoseValues;
  /** Metres between the finger tips. */
  readonly opening: number;
}

/** The arm of another robot; its tool is in its own base frame. */
export interface ShownArm extends ArmPose {
  /** Its place among the layout's `arms`. */
  readonly number: number;
  /** Its base frame in that of the layout's robot. */
  readonly base: PoseValues;
  /** How old that is, in seconds of the run's clock. */
  readonly age: number;
}

/** Where everything is at one moment of a run; poses but those of bases are in the robot's base frame. */
export interface Frame extends ArmPose {
  /** Seconds of the run's clock. */
  readonly time: number;
  readonly number: number;
  readonly base: PoseValues;
  /** In the order of the layout's objects. */
  readonly objects: readonly ShownObject[];
  /** In the order of the layout's robots. */
  readonly robots: readonly ShownBase[];
  /** Of other robots, as far as they have told anything. */
  readonly arms: readonly ShownArm[];
}

const HEAD_BYTES = 16;
const FIXED_BYTES = 76;
const OBJECT_BYTES = 32;
const ROBOT_BYTES = 32;
const LENGTH_BYTES = 4;
const ARM_BYTES = 68;
const ARMS_END_BYTES = 8;
/** `ARMS`, as a little-endian number. */
const ARMS = 0x534d5241;
const POSE_VALUES = 7;
const HELD = 1;
const GONE = 2;
const HIDDEN = 4;

/** Read one frame. Throws `RangeError` for bytes that are none. */
export function decodeFrame(bytes: ArrayBuffer, start = 0, length = bytes.byteLength - start): Frame {
  if (length < FIXED_BYTES) throw new RangeError(`a frame of poses has at least 76 bytes, not ${length}`);
  const view = new DataView(bytes, start, length);
  const jointCount = view.getUint16(12, true);
  const objectCount = view.getUint16(14, true);
  const expected = FIXED_BYTES + 4 * jointCount + OBJECT_BYTES * objectCount;
  const armsAt = length - armsBytes(view);
  const robotCount = (armsAt - expected) / ROBOT_BYTES;
  if (robotCount < 0 || !Number.isInteger(robotCount)) {
    throw new RangeError(
      `a frame of ${jointCount} joints and ${objectCount} objects has ${expected} bytes and 32 a robot, not ${length}`,
    );
  }
  const base = HEAD_BYTES + 4 * jointCount;
  const objects = FIXED_BYTES + 4 * jointCount;
  return {
    time: view.getFloat64(0, true),
    number: view.getUint32(8, true),
    joints: floats(view, HEAD_BYTES, jointCount),
    base: floats(view, base, POSE_VALUES),
    tool: floats(view, base + 4 * POSE_VALUES, POSE_VALUES),
    opening: view.getFloat32(base + 8 * POSE_VALUES, true),
    objects: Array.from({ length: objectCount }, (_, index) => object(view, objects + OBJECT_BYTES * index)),
    robots: Array.from({ length: robotCount }, (_, index) => robot(view, expected + ROBOT_BYTES * index)),
    arms: arms(view, armsAt),
  };
}

/** How many of the last bytes tell of other arms. */
function armsBytes(view: DataView): number {
  const end = view.byteLength - ARMS_END_BYTES;
  return view.getUint32(end + 4, true) === ARMS ? view.getUint32(end, true) + ARMS_END_BYTES : 0;
}

function arms(view: DataView, first: number): ShownArm[] {
  const found: ShownArm[] = [];
  let at = first;
  while (at < view.byteLength - ARMS_END_BYTES) {
    const joints = view.getUint16(at + 2, true);
    found.push({
      number: view.getUint16(at, true),
      base: floats(view, at + 4, POSE_VALUES),
      tool: floats(view, at + 32, POSE_VALUES),
      opening: view.getFloat32(at + 60, true),
      age: view.getFloat32(at + 64, true),
      joints: floats(view, at + ARM_BYTES, joints),
    });
    at += ARM_BYTES + 4 * joints;
  }
  return found;
}

/** Read recorded frames, each after its length; one that is torn off at the end is left out. */
export function decodeFrames(bytes: ArrayBuffer): Frame[] {
  const frames: Frame[] = [];
  const view = new DataView(bytes);
  let at = 0;
  while (at + LENGTH_BYTES <= bytes.byteLength) {
    const length = view.getUint32(at, true);
    at += LENGTH_BYTES;
    if (at + length > bytes.byteLength) break;
    frames.push(decodeFrame(bytes, at, length));
    at += length;
  }
  return frames;
}

function object(view: DataView, at: number): ShownObject {
  const flags = view.getUint32(at + 4 * POSE_VALUES, true);
  return {
    pose: floats(view, at, POSE_VALUES),
    held: (flags & HELD) !== 0,
    gone: (flags & GONE) !== 0,
    hidden: (flags & HIDDEN) !== 0,
  };
}

function robot(view: DataView, at: number): ShownBase {
  return { pose: floats(view, at, POSE_VALUES), age: view.getFloat32(at + 4 * POSE_VALUES, true) };
}

// A Float32Array over the bytes themselves would need a little-endian machine and aligned frames.
function floats(view: DataView, at: number, count: number): Float32Array {
  const values = new Float32Array(count);
  for (let index = 0; index < count; index += 1) values[index] = view.getFloat32(at + 4 * index, true);
  return values;
}

// Frames of poses as the service would send them.
interface Wanted {
  time?: number;
  number?: number;
  joints?: number[];
  opening?: number;
  objects?: { x?: number; y?: number; yaw?: number; flags?: number }[];
  robots?: { x?: number; y?: number; z?: number; yaw?: number; age?: number }[];
  arms?: { number?: number; x?: number; joints?: number[]; opening?: number; age?: number }[];
}

export function frameBytes(wanted: Wanted): ArrayBuffer {
  const { time = 0, number = 0, joints = [], opening = 0, objects = [], robots = [], arms = [] } = wanted;
  const armBytes = arms.reduce((sum, each) => sum + 68 + 4 * (each.joints ?? []).length, 0);
  const end = arms.length > 0 ? 8 : 0;
  const bytes = new ArrayBuffer(76 + 4 * joints.length + 32 * objects.length + 32 * robots.length + armBytes + end);
  const view = new DataView(bytes);
  view.setFloat64(0, time, true);
  view.setUint32(8, number, true);
  view.setUint16(12, joints.length, true);
  view.setUint16(14, objects.length, true);
  let at = 16;
  const put = (...values: number[]) => {
    for (const value of values) {
      view.setFloat32(at, value, true);
      at += 4;
    }
  };
  put(...joints, 0, 0, 0, 0, 0, 0, 1, 0.5, -0.25, 0.75, 0, 0, 0, 1, opening);
  for (const { x = 0, y = 0, yaw = 0, flags = 0 } of objects) {
    put(x, y, 0.7, 0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2));
    view.setUint32(at, flags, true);
    at += 4;
  }
  for (const { x = 0, y = 0, z = 0, yaw = 0, age = 0 } of robots) {
    put(x, y, z, 0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2), age);
  }
  for (const { number: which = 0, x = 0, joints: angles = [], opening: apart = 0, age = 0 } of arms) {
    view.setUint16(at, which, true);
    view.setUint16(at + 2, angles.length, true);
    at += 4;
    put(x, 0, 0, 0, 0, 0, 1, 0.25, 0, 0.75, 0, 0, 0, 1, apart, age, ...angles);
  }
  if (end > 0) {
    view.setUint32(at, armBytes, true);
    for (const [index, letter] of [..."ARMS"].entries()) view.setUint8(at + 4 + index, letter.charCodeAt(0));
  }
  return bytes;
}

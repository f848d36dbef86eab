// From a scene's plane to a drawing seen from above: x forward is up, y left is left.
import type { Pose, SceneSource } from "./scene_source";

export interface ViewFrame {
  /** Pixels a metre. */
  scale: number;
  width: number;
  height: number;
  left(y: number): number;
  top(x: number): number;
  /** The point of the scene at a point of the drawing. */
  at(left: number, top: number): { x: number; y: number };
}

const AROUND_M = 0.12;
const ROBOT_M = 0.3;

/** As large as the room allows, in pixels. */
export function viewFrame({ table, things }: SceneSource, mostWidth: number, mostHeight: number): ViewFrame {
  const [x, y] = [[...edges(table.center[0], table.size[0])], [...edges(table.center[1], table.size[1])]];
  for (const thing of things) {
    const half = thing.kind === "robot" ? ROBOT_M : Math.hypot(thing.size?.[0] ?? 0.1, thing.size?.[1] ?? 0.1) / 2;
    x.push(thing.pose.x - half, thing.pose.x + half);
    y.push(thing.pose.y - half, thing.pose.y + half);
  }
  const [farthest, nearest] = [Math.max(...x) + AROUND_M, Math.min(...x) - AROUND_M];
  const [leftmost, rightmost] = [Math.max(...y) + AROUND_M, Math.min(...y) - AROUND_M];
  const scale = Math.min(mostWidth / (leftmost - rightmost), mostHeight / (farthest - nearest));
  return {
    scale,
    width: (leftmost - rightmost) * scale,
    height: (farthest - nearest) * scale,
    left: (at) => (leftmost - at) * scale,
    top: (at) => (farthest - at) * scale,
    at: (left, top) => ({ x: farthest - top / scale, y: leftmost - left / scale }),
  };
}

function edges(center = 0, size = 0): [number, number] {
  return [center - size / 2, center + size / 2];
}

/** How a drawing of something that points up is put where a pose says. */
export function placed(frame: ViewFrame, { x, y, yaw }: Pose): string {
  return `translate(${frame.left(y)} ${frame.top(x)}) rotate(${(-yaw * 180) / Math.PI})`;
}

// Poses of the wire, given to what is drawn.
import type { Object3D } from "three";
import type { PoseValues } from "./decode";

export function setPose(target: Object3D, pose: PoseValues): void {
  target.position.fromArray(pose);
  target.quaternion.fromArray(pose, 3);
}

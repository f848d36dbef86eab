// The 3-D scene of one layout: shows frames, says what is under a pointer and where names belong.
import { Group, type Mesh, type Object3D, Raycaster, Vector2, Vector3 } from "three";
import type { Layout } from "../../wire/types";
import { createArms } from "./arms";
import type { Frame } from "./decode";
import { createFurniture } from "./furniture";
import { readPalette } from "./palette";
import { createParts, type Part } from "./parts";
import { setPose } from "./poses";
import { createStage } from "./stage";

/** Where poses come from: what to show at `now`, and whether that changes without more of them. */
export interface Poses {
  at(now: number): Frame | null;
  moving(now: number): boolean;
}

export type Pointed =
  | { readonly kind: "object"; readonly name: string }
  | { readonly kind: "arm" }
  /** Metres in the robot's base frame. */
  | { readonly kind: "table"; readonly x: number; readonly y: number };

/** Where the middle of an object is in the picture, or the tool of one of several robots, in CSS pixels. */
export interface Spot {
  readonly name: string;
  readonly x: number;
  readonly y: number;
  /** How far above the middle its top is. */
  readonly rise: number;
  readonly held: boolean;
}

export interface SceneView {
  invalidate(): void;
  /** What is at a point of the picture, in CSS pixels. */
  pointedAt(x: number, y: number): Pointed | null;
  /** Where an object, or the tool for null, is in the picture. */
  spotOf(name: string | null): { x: number; y: number } | null;
  highlight(name: string | null): void;
  turn(azimuth: number, polar: number): void;
  zoom(nearer: boolean): void;
  resetCamera(): void;
  /** Take the colours of the theme anew. */
  repaint(): void;
  dispose(): void;
}

/** Throws where the browser has no WebGL. `modelMissing` is called when the model cannot be loaded. */
export function createSceneView(
  canvas: HTMLCanvasElement,
  layout: Layout,
  poses: Poses,
  drawn: (spots: readonly Spot[]) => void,
  modelMissing: () => void,
): SceneView {
  const furniture = createFurniture(layout);
  const parts = createParts(layout.objects);
  // The robot's base frame; all else of a frame is given in it.
  const base = new Group();
  base.add(furniture.root, parts.root);
  let shown: Frame | null = null;

  const show = (now: number) => {
    const frame = poses.at(now);
    if (frame !== null && frame !== shown) {
      setPose(base, frame.base);
      parts.show(frame);
      arms.show(frame);
      shown = frame;
    }
    return poses.moving(now);
  };
  const stage = createStage(canvas, show, () => drawn(spots()));
  stage.scene.add(base);
  const [x, y] = layout.table.center;
  stage.orbit.lookAt(new Vector3(x * 0.8, y, layout.table.height_m));

  const arms = createArms(layout, stage.invalidate, modelMissing);
  base.add(arms.root);

  const project = (at: Vector3) => {
    const { x: right, y: up, z } = at.project(stage.camera);
    const { clientWidth, clientHeight } = canvas;
    return z > 1 ? null : { x: ((right + 1) / 2) * clientWidth, y: ((1 - up) / 2) * clientHeight };
  };
  const projectPart = ({ root, layout: { size_m } }: Part, share: number) =>
    project(root.localToWorld(new Vector3(0, 0, size_m[2] * share)));

  const toolSpots = (): Spot[] =>
    arms.tools().flatMap(({ robot, at }) => {
      const spot = project(at);
      return spot === null ? [] : [{ name: robot, ...spot, rise: 0, held: false }];
    });

  const spots = (): Spot[] => [...partSpots(), ...toolSpots()];

  const partSpots = (): Spot[] =>
    parts.all.flatMap((part, index) => {
      const middle = part.root.visible && part.layout.kind === "object" ? projectPart(part, 0.5) : null;
      const top = middle === null ? null : projectPart(part, 1);
      if (middle === null || top === null) return [];
      const held = shown?.objects[index]?.held ?? false;
      return [{ name: part.layout.name, ...middle, rise: Math.max(middle.y - top.y, 0), held }];
    });

  const repaint = () => {
    const palette = readPalette(canvas.parentElement ?? document.body);
    furniture.paint(palette);
    parts.paint(palette);
    stage.paint(palette);
  };
  repaint();

  return {
    invalidate: stage.invalidate,
    pointedAt(left, top) {
      const ray = new Raycaster();
      const { clientWidth, clientHeight } = canvas;
      ray.setFromCamera(new Vector2((2 * left) / clientWidth - 1, 1 - (2 * top) / clientHeight), stage.camera);
      const visible = parts.all.filter((each) => each.root.visible);
      const solid: Object3D[] = [furniture.top, arms.root, ...visible.flatMap((each) => bodiesOf(each))];
      const [hit] = ray.intersectObjects(solid, true);
      if (hit === undefined) return null;
      const part = visible.find((each) => bodiesOf(each).includes(hit.object));
      if (part !== undefined) return meant(part);
      if (hit.object !== furniture.top) return { kind: "arm" };
      const { x: ahead, y: aside } = base.worldToLocal(hit.point.clone());
      return { kind: "table", x: ahead, y: aside };
    },
    spotOf(name) {
      if (name === null) {
        return shown === null ? null : project(base.localToWorld(new Vector3().fromArray(shown.tool)));
      }
      const part = parts.all.find((each) => each.layout.name === name);
      return part === undefined || !part.root.visible ? null : projectPart(part, 0.5);
    },
    highlight(name) {
      parts.highlight(name);
      stage.invalidate();
    },
    turn: stage.orbit.turn,
    zoom: stage.orbit.zoom,
    resetCamera: stage.orbit.reset,
    repaint,
    dispose() {
      arms.dispose();
      stage.dispose();
    },
  };
}

function bodiesOf({ root, rim }: Part): Object3D[] {
  return root.children.filter((each): each is Mesh => each !== rim);
}

/** Whoever stands in the way is no object of its own: what can be done is done about the arm's way. */
function meant({ layout: { kind, name } }: Part): Pointed {
  return kind === "object" ? { kind, name } : { kind: "arm" };
}

// The robot in the scene: its model where there is one, else a two-finger gripper at the tool point.
import {
  BoxGeometry,
  Color,
  Group,
  LoaderUtils,
  LoadingManager,
  type Material,
  Mesh,
  MeshLambertMaterial,
  SRGBColorSpace,
} from "three";
import URDFLoader, { type URDFRobot, type URDFVisual } from "urdf-loader";
import type { ArmPose } from "./decode";
import { hasOwnColors, loadMesh } from "./meshes";
import { setPose } from "./poses";

// As the simulator paints its robot, whose own colours are for debugging.
const ARM = new Color().setRGB(0.8, 0.8, 0.82, SRGBColorSpace);
const GRIPPER = new Color().setRGB(0.35, 0.36, 0.38, SRGBColorSpace);

export interface DrawnRobot {
  readonly root: Group;
  show(arm: ArmPose): void;
}

/** A robot's model, and whether it is drawn in its own colours or as the simulator paints it. */
export interface Model {
  readonly address: string;
  readonly ownColors: boolean;
}

/** Load a robot's model. Rejects when it cannot be had; its meshes may come after it (`changed`). */
export async function loadRobot(
  { address, ownColors }: Model,
  joints: readonly string[],
  changed: () => void,
): Promise<DrawnRobot> {
  const arm = new MeshLambertMaterial({ color: ARM });
  const gripper = new MeshLambertMaterial({ color: GRIPPER });
  const paint = ownColors ? (robot: URDFRobot) => paintBare(robot, arm) : (robot: URDFRobot) => paintAll(robot, arm, gripper);
  let robot: URDFRobot | null = null;
  // Each mesh as it comes: of a file that two robots load at once only one of them hears the end.
  const came = () => {
    if (robot !== null) paint(robot);
    changed();
  };
  const manager = new LoadingManager();
  const loader = new URDFLoader(manager);
  // A package is a folder beside the description.
  loader.packages = (name) => LoaderUtils.extractUrlBase(address) + name;
  loader.loadMeshCb = (url, meshManager, material, done) => {
    loadMesh(url, meshManager, material).then(
      (mesh) => {
        done(mesh);
        came();
      },
      (error: unknown) => done(new Group(), error as Error),
    );
  };
  const read = await loader.loadAsync(address);
  robot = read;
  came();
  const root = new Group();
  root.add(read);
  return {
    root,
    show(arm) {
      for (const [index, name] of joints.entries()) read.setJointValue(name, arm.joints[index] as number);
    },
  };
}

function paintAll(robot: URDFRobot, arm: Material, gripper: Material): void {
  for (const { link, visual } of visualsOf(robot)) paintVisual(visual, link.startsWith("r_gripper_") ? gripper : arm);
}

/** What says no colour is grey like an arm, and all else stays as it is. */
function paintBare(robot: URDFRobot, arm: Material): void {
  for (const { visual } of visualsOf(robot)) {
    const said = visual.urdfNode;
    const mesh = said?.querySelector("mesh")?.getAttribute("filename") ?? "";
    const colored = said?.querySelector("material") != null || hasOwnColors(mesh);
    paintVisual(visual, colored ? null : arm);
  }
}

function visualsOf(robot: URDFRobot): { link: string; visual: URDFVisual }[] {
  return Object.entries(robot.links).flatMap(([link, { children }]) =>
    children.filter((each): each is URDFVisual => "isURDFVisual" in each).map((visual) => ({ link, visual })),
  );
}

function paintVisual(visual: URDFVisual, material: Material | null): void {
  visual.traverse((each) => {
    if (!(each instanceof Mesh)) return;
    if (material !== null) each.material = material;
    each.castShadow = true;
    each.receiveShadow = true;
  });
}

const FINGER_M = [0.07, 0.012, 0.02] as const;

/** Fingers and palm in the tool's frame: x is the way it reaches, y the way the fingers open. */
export function createGripper(): DrawnRobot {
  const metal = new MeshLambertMaterial({ color: GRIPPER });
  const arm = new MeshLambertMaterial({ color: ARM });
  const box = (size: readonly [number, number, number], x: number, material: MeshLambertMaterial) => {
    const mesh = new Mesh(new BoxGeometry(...size), material);
    mesh.position.x = x;
    mesh.castShadow = true;
    return mesh;
  };
  const fingers = [box(FINGER_M, -0.025, metal), box(FINGER_M, -0.025, metal)] as const;
  const root = new Group();
  root.add(...fingers, box([0.04, 0.13, 0.05], -0.08, metal), box([0.3, 0.05, 0.05], -0.25, arm));
  return {
    root,
    show(arm) {
      setPose(root, arm.tool);
      const aside = arm.opening / 2 + FINGER_M[1] / 2;
      fingers[0].position.y = aside;
      fingers[1].position.y = -aside;
    },
  };
}

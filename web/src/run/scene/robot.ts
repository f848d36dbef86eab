// The robot in the scene: its model where there is one, else a two-finger gripper at the tool point.
import { BoxGeometry, type BufferGeometry, Color, Group, LoadingManager, Mesh, MeshLambertMaterial, SRGBColorSpace } from "three";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import URDFLoader, { type URDFRobot } from "urdf-loader";
import type { ArmPose } from "./decode";
import { setPose } from "./poses";

// As the simulator paints it; the model's own colours are for debugging.
const ARM = new Color().setRGB(0.8, 0.8, 0.82, SRGBColorSpace);
const GRIPPER = new Color().setRGB(0.35, 0.36, 0.38, SRGBColorSpace);
const CREASE_RAD = 0.6;

export interface DrawnRobot {
  readonly root: Group;
  show(arm: ArmPose): void;
}

/** Load a robot's model. Rejects when it cannot be had; its meshes may come after it (`changed`). */
export async function loadRobot(
  address: string,
  joints: readonly string[],
  changed: () => void,
): Promise<DrawnRobot> {
  const arm = new MeshLambertMaterial({ color: ARM });
  const gripper = new MeshLambertMaterial({ color: GRIPPER });
  let robot: URDFRobot | null = null;
  // Each mesh as it comes: of a file that two robots load at once only one of them hears the end.
  const came = () => {
    if (robot !== null) paint(robot, arm, gripper);
    changed();
  };
  const manager = new LoadingManager();
  const loader = new URDFLoader(manager);
  const meshes = new STLLoader(manager);
  loader.loadMeshCb = (url, _manager, _material, done) => {
    const failed = (error: unknown) => done(new Group(), error as Error);
    const take = (geometry: BufferGeometry) => {
      done(new Mesh(toCreasedNormals(geometry, CREASE_RAD)));
      came();
    };
    meshes.load(url, take, undefined, failed);
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

function paint(robot: URDFRobot, arm: MeshLambertMaterial, gripper: MeshLambertMaterial): void {
  for (const [name, link] of Object.entries(robot.links)) {
    for (const visual of link.children.filter((each) => "isURDFVisual" in each)) {
      visual.traverse((each) => {
        if (!(each instanceof Mesh)) return;
        each.material = name.startsWith("r_gripper_") ? gripper : arm;
        each.castShadow = true;
        each.receiveShadow = true;
      });
    }
  }
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

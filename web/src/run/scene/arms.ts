// The robots of the scene, each in its own base frame: that of the layout, and the other arms of its run.
import { Group, Vector3 } from "three";
import type { Layout } from "../../wire/types";
import type { ArmPose, Frame } from "./decode";
import { setPose } from "./poses";
import { release } from "./release";
import { createGripper, type DrawnRobot, loadRobot } from "./robot";

export interface Arms {
  /** In the base frame of the layout's robot. */
  readonly root: Group;
  show(frame: Frame): void;
  /** Where the tool of each robot is in the world; of none as long as there is one robot alone. */
  tools(): readonly Tool[];
  dispose(): void;
}

export interface Tool {
  readonly robot: string;
  readonly at: Vector3;
}

/** What a layout says of how a robot is drawn. */
type Shown = Pick<Layout, "model" | "own_colors" | "joints">;

interface Arm {
  readonly root: Group;
  show(pose: ArmPose): void;
  tool(): Vector3 | null;
}

/** `changed` is called when there is more to draw, `modelMissing` when a model cannot be loaded. */
export function createArms(layout: Layout, changed: () => void, modelMissing: () => void): Arms {
  const root = new Group();
  let disposed = false;

  const add = ({ model, own_colors, joints }: Shown): Arm => {
    const base = new Group();
    let drawn: DrawnRobot | null = null;
    let latest: ArmPose | null = null;
    const join = (loaded: DrawnRobot) => {
      if (disposed) {
        release(loaded.root);
        return;
      }
      drawn = loaded;
      base.add(loaded.root);
      if (latest !== null) loaded.show(latest);
      changed();
    };
    if (model === null) join(createGripper());
    else {
      loadRobot({ address: model, ownColors: own_colors }, joints, changed).then(join, () => {
        if (!disposed) modelMissing();
        join(createGripper());
      });
    }
    return {
      root: base,
      show(pose) {
        latest = pose;
        drawn?.show(pose);
      },
      tool: () => (latest === null ? null : base.localToWorld(new Vector3().fromArray(latest.tool))),
    };
  };

  const own = add(layout);
  const others = layout.arms.map(add);
  const named = [...(others.length > 0 ? [[layout.robot, own] as const] : []), ...layout.arms.map((each, index) => [each.robot, others[index] as Arm] as const)];
  root.add(own.root);
  return {
    root,
    show(frame) {
      own.show(frame);
      for (const pose of frame.arms) {
        const arm = others[pose.number];
        if (arm === undefined) continue;
        setPose(arm.root, pose.base);
        // Where it stands is known only now.
        root.add(arm.root);
        arm.show(pose);
      }
    },
    tools: () =>
      named.flatMap(([robot, arm]) => {
        const at = arm.tool();
        return at === null ? [] : [{ robot, at }];
      }),
    dispose() {
      disposed = true;
    },
  };
}

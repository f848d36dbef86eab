// Levels, potentials and what follows for goal nodes from what became of the leaves.
import type { TreeShape } from "./tree_shape";

export type LeafStatus = "idle" | "active" | "done";

export interface NodeActivation {
  level: number;
  potential: number;
  active: boolean;
  done: boolean;
  abandoned: boolean;
}

/** What a tree's activation follows from. */
export interface TreeCondition {
  running: boolean;
  statusOf(leaf: number): LeafStatus;
  /** The potential of a leaf where nothing keeps it from being started. */
  potentialOf(leaf: number): number;
  /** The alternatives that were given up. */
  abandoned: ReadonlySet<number>;
}

/** Shares of shares may be too small for a number; they must not become 0 all the same. */
const SMALLEST_LEVEL = Number.MIN_VALUE;
const NO_NODE = -1;

interface Derived {
  active: boolean[];
  done: boolean[];
  touched: boolean[];
  abandoned: boolean[];
}

export function activationOf(shape: TreeShape, condition: TreeCondition): NodeActivation[] {
  const derived = derive(shape, condition);
  const competing = shape.kinds.map((_, node) => competingChildren(shape, derived, node));
  const levels = levelsOf(shape, derived, competing, condition.running);
  const potentials = potentialsOf(shape, derived, competing, condition);
  return shape.kinds.map((_, node) => ({
    level: levels[node] as number,
    potential: potentials[node] as number,
    active: derived.active[node] as boolean,
    done: derived.done[node] as boolean,
    abandoned: derived.abandoned[node] as boolean,
  }));
}

function derive(shape: TreeShape, condition: TreeCondition): Derived {
  const size = shape.kinds.length;
  const flags = () => new Array<boolean>(size).fill(false);
  const derived: Derived = { active: flags(), done: flags(), touched: flags(), abandoned: flags() };
  for (let node = size - 1; node >= 0; node--) {
    const children = shape.children[node] as readonly number[];
    if (shape.kinds[node] === "behavior") {
      const status = condition.statusOf(node);
      derived.active[node] = status === "active";
      derived.done[node] = status === "done";
      derived.touched[node] = status !== "idle";
    } else {
      const isDone = (child: number) => derived.done[child] === true;
      derived.active[node] = children.some((child) => derived.active[child]);
      derived.touched[node] = children.some((child) => derived.touched[child]);
      derived.done[node] = shape.kinds[node] === "or" ? children.some(isDone) : children.every(isDone);
    }
  }
  for (let node = 0; node < size; node++) {
    const parent = shape.parents[node] as number;
    derived.abandoned[node] = condition.abandoned.has(node) || (parent >= 0 && derived.abandoned[parent] === true);
  }
  return derived;
}

/** The children to which a goal node that is not done passes its level. */
function competingChildren(shape: TreeShape, derived: Derived, goal: number): readonly number[] {
  const children = shape.children[goal] as readonly number[];
  switch (shape.kinds[goal]) {
    case "then": {
      const next = children.find((child) => !derived.done[child]) ?? NO_NODE;
      return next === NO_NODE ? [] : [next];
    }
    case "or": {
      const committed = children.find((child) => derived.touched[child]) ?? NO_NODE;
      return committed === NO_NODE ? children.filter((child) => !derived.abandoned[child]) : [committed];
    }
    default:
      return children.filter((child) => !derived.done[child]);
  }
}

function levelsOf(
  shape: TreeShape,
  derived: Derived,
  competing: readonly (readonly number[])[],
  running: boolean,
): number[] {
  const levels = shape.kinds.map(() => 0);
  levels[0] = running && !derived.done[0] ? 1 : 0;
  for (const [goal, children] of competing.entries()) {
    const level = levels[goal] as number;
    if (level === 0) continue;
    const share = shape.kinds[goal] === "and" ? Math.max(level / children.length, SMALLEST_LEVEL) : level;
    for (const child of children) {
      if (!derived.done[child] && !(shape.kinds[goal] === "or" && derived.abandoned[child])) levels[child] = share;
    }
  }
  return levels;
}

function potentialsOf(
  shape: TreeShape,
  derived: Derived,
  competing: readonly (readonly number[])[],
  condition: TreeCondition,
): number[] {
  const potentials = shape.kinds.map(() => 0);
  const startable = shape.kinds.map(() => false);
  for (let node = shape.kinds.length - 1; node >= 0; node--) {
    if (derived.done[node] || derived.abandoned[node]) continue;
    if (shape.kinds[node] === "behavior") {
      potentials[node] = condition.potentialOf(node);
      startable[node] = condition.statusOf(node) === "idle";
      continue;
    }
    const children = competing[node] as readonly number[];
    startable[node] = children.some((child) => startable[child]);
    const counted = shape.kinds[node] === "and" ? children.filter((child) => startable[child]) : children;
    for (const child of counted) potentials[node] = Math.max(potentials[node] as number, potentials[child] as number);
  }
  return potentials;
}

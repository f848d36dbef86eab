// One node of a task tree as it is drawn: from a run at some moment, or from a definition alone.
import type { NodeView, RunResult } from "../wire/types";

export type NodeKind = NodeView["kind"];

/** `failed` and `left`: what could not be done, and what is not done, once a run has ended. */
export type NodeState = "waiting" | "eligible" | "active" | "in_dialogue" | "done" | "abandoned" | "failed" | "left";

/** Nodes stand depth first; `path` is that of child indices from the root (`/` is the root). */
export interface TreeNode {
  path: string;
  kind: NodeKind;
  name: string;
  behavior: string | null;
  /** Null in a tree that does not run: neither are there a level, a potential or an owner then. */
  state: NodeState | null;
  level: number | null;
  potential: number | null;
  owner: string | null;
  /** Whether the owner is a person, who does it themselves. */
  byPerson: boolean;
  /** Attempts that have failed. */
  attempts: number;
  /** How people steer it: whether a breakpoint stands before it, whether it waits, whether it is to be next. */
  steered: Steered | null;
}

export interface Steered {
  breakpoint: boolean;
  waits: boolean;
  next: boolean;
}

/** The nodes of a run, from what the service or the fold says of them; `result` once it has ended. */
export function nodesOfRun(
  views: readonly NodeView[],
  inDialogue: ReadonlySet<string>,
  people: ReadonlyMap<string, unknown> = new Map(),
  result: Pick<RunResult, "node"> | null = null,
  steered: ReadonlyMap<string, Steered> = new Map(),
): TreeNode[] {
  return views.map((view) => ({
    path: view.node,
    kind: view.kind,
    name: view.name,
    behavior: view.behavior,
    state: result === null ? stateOf(view, inDialogue) : stateAtEnd(view, result),
    level: view.activation_level,
    potential: view.activation_potential,
    owner: view.owner,
    byPerson: people.has(view.node),
    attempts: view.attempts,
    steered: steered.get(view.node) ?? null,
  }));
}

function stateOf(view: NodeView, inDialogue: ReadonlySet<string>): NodeState {
  if (view.done) return "done";
  if (view.abandoned) return "abandoned";
  if (inDialogue.has(view.node)) return "in_dialogue";
  if (view.active) return "active";
  return view.activation_level > 0 ? "eligible" : "waiting";
}

/** Nothing waits any more, and nobody is at anything. */
function stateAtEnd(view: NodeView, result: Pick<RunResult, "node">): NodeState {
  if (view.done) return "done";
  if (view.abandoned) return "abandoned";
  return view.node === result.node ? "failed" : "left";
}

/** The nodes of a checked definition in its JSON form, as of `DocumentView.definition`. */
export function nodesOfDefinition(definition: Readonly<Record<string, unknown>>): TreeNode[] {
  const nodes = definition.nodes as readonly DefinedNode[];
  const paths = pathsOf(nodes.map((node) => node.parent ?? null));
  return nodes.map((node, index) => ({
    path: paths[index] as string,
    kind: node.kind,
    name: node.name,
    behavior: node.behavior ?? null,
    state: null,
    level: null,
    potential: null,
    owner: null,
    byPerson: false,
    attempts: 0,
    steered: null,
  }));
}

/** A node in the JSON form of a definition; parents come before their children. */
export interface DefinedNode {
  kind: NodeKind;
  parent: number | null;
  name: string;
  behavior?: string;
  parameters?: Readonly<Record<string, unknown>>;
}

/** The path of every node, from the indices of the parents. */
export function pathsOf(parents: readonly (number | null)[]): string[] {
  const children = new Map<number, number>();
  const paths: string[] = [];
  for (const parent of parents) {
    if (parent === null) {
      paths.push("/");
      continue;
    }
    const position = children.get(parent) ?? 0;
    children.set(parent, position + 1);
    const above = paths[parent] as string;
    paths.push(above === "/" ? `/${position}` : `${above}/${position}`);
  }
  return paths;
}

/** The path of the node above; null for the root. */
export function parentOf(path: string): string | null {
  if (path === "/") return null;
  return path.slice(0, path.lastIndexOf("/")) || "/";
}

/** The paths above a node, the nearest first. */
export function pathsAbove(path: string): string[] {
  const above: string[] = [];
  for (let parent = parentOf(path); parent !== null; parent = parentOf(parent)) above.push(parent);
  return above;
}

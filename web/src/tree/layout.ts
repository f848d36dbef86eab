// Where each node of a task tree is drawn, and which ones are while the tree is large.
import { hierarchy, type HierarchyNode, tree as tidyTree } from "d3-hierarchy";
import { parentOf, pathsAbove, type TreeNode } from "./tree_node";

/** One node in its place; px of the drawing's own coordinates. */
export interface PlacedNode {
  node: TreeNode;
  x: number;
  y: number;
  width: number;
  height: number;
  /** 1 for the root. */
  depth: number;
  /** From 1, among `siblings`. */
  position: number;
  siblings: number;
  /** How many nodes are folded away under it. */
  hidden: number;
  expandable: boolean;
}

/** A line from a goal node to a child. */
export interface Edge {
  from: PlacedNode;
  to: PlacedNode;
}

export interface TreeLayout {
  /** `across`: children to the right of their parents; `down`: below them and indented. */
  direction: "across" | "down";
  nodes: readonly PlacedNode[];
  edges: readonly Edge[];
  width: number;
  height: number;
}

/** The sizes of cards and gaps, in px. */
export interface Measures {
  goalWidth: number;
  leafWidth: number;
  height: number;
  rowGap: number;
  columnGap: number;
}

export const FULL: Measures = { goalWidth: 184, leafWidth: 216, height: 60, rowGap: 12, columnGap: 40 };
export const COMPACT: Measures = { goalWidth: 164, leafWidth: 148, height: 32, rowGap: 8, columnGap: 32 };

const MARGIN = 8;
const INDENT = 28;
const SMALLEST_INDENT = 12;
/** Smaller than this nobody could read it; the indented form is taken instead. */
const SMALLEST_SCALE = 0.8;

interface Branch {
  node: TreeNode;
  position: number;
  children: Branch[];
}

/** Place the nodes; those under a path of `collapsed` are left out. */
export function layoutTree(
  nodes: readonly TreeNode[],
  collapsed: ReadonlySet<string>,
  width: number,
  measures: Measures,
): TreeLayout {
  const root = branches(nodes);
  if (root === null) return { direction: "across", nodes: [], edges: [], width: 0, height: 0 };
  const shown = hierarchy(root, (branch) => (collapsed.has(branch.node.path) ? [] : branch.children));
  const sizes = sizesUnder(nodes);
  const across = acrossLayout(shown, sizes, measures);
  return across.width * SMALLEST_SCALE <= width ? across : downLayout(shown, sizes, width, measures);
}

function branches(nodes: readonly TreeNode[]): Branch | null {
  const byPath = new Map<string, Branch>();
  for (const node of nodes) {
    const parent = parentOf(node.path);
    const above = parent === null ? undefined : byPath.get(parent);
    const branch: Branch = { node, position: (above?.children.length ?? 0) + 1, children: [] };
    byPath.set(node.path, branch);
    above?.children.push(branch);
  }
  return byPath.get("/") ?? null;
}

/** How many nodes there are under each node. */
function sizesUnder(nodes: readonly TreeNode[]): ReadonlyMap<string, number> {
  const sizes = new Map<string, number>();
  for (let i = nodes.length - 1; i > 0; i--) {
    const { path } = nodes[i] as TreeNode;
    const parent = parentOf(path) as string;
    sizes.set(parent, (sizes.get(parent) ?? 0) + (sizes.get(path) ?? 0) + 1);
  }
  return sizes;
}

function acrossLayout(
  root: HierarchyNode<Branch>,
  sizes: ReadonlyMap<string, number>,
  measures: Measures,
): TreeLayout {
  const row = measures.height + measures.rowGap;
  const points = tidyTree<Branch>()
    .nodeSize([row, 1])
    .separation(() => 1)(root);
  const columns = columnsOf(points, measures);
  let top = 0;
  points.eachBefore((point) => {
    top = Math.min(top, point.x);
  });
  const placed = place(points, sizes, (point) => ({
    x: columns[point.depth] as number,
    y: point.x - top + MARGIN,
    width: widthOf(point.data.node, measures),
    height: measures.height,
  }));
  return { direction: "across", ...placed };
}

function columnsOf(root: HierarchyNode<Branch>, measures: Measures): number[] {
  const widths: number[] = [];
  root.eachBefore(({ depth, data }) => {
    widths[depth] = Math.max(widths[depth] ?? 0, widthOf(data.node, measures));
  });
  let x = MARGIN;
  return widths.map((width) => {
    const column = x;
    x += width + measures.columnGap;
    return column;
  });
}

function widthOf(node: TreeNode, measures: Measures): number {
  return node.kind === "behavior" ? measures.leafWidth : measures.goalWidth;
}

function downLayout(
  root: HierarchyNode<Branch>,
  sizes: ReadonlyMap<string, number>,
  width: number,
  measures: Measures,
): TreeLayout {
  const room = width - 2 * MARGIN - measures.leafWidth;
  const indent = Math.max(SMALLEST_INDENT, Math.min(INDENT, room / Math.max(root.height, 1)));
  let row = 0;
  const placed = place(root, sizes, (point) => ({
    x: MARGIN + point.depth * indent,
    y: MARGIN + row++ * (measures.height + measures.rowGap),
    width: widthOf(point.data.node, measures),
    height: measures.height,
  }));
  return { direction: "down", ...placed };
}

type Box = Pick<PlacedNode, "x" | "y" | "width" | "height">;

function place<P extends HierarchyNode<Branch>>(
  root: P,
  sizes: ReadonlyMap<string, number>,
  box: (point: P) => Box,
): Omit<TreeLayout, "direction"> {
  const nodes: PlacedNode[] = [];
  const byPath = new Map<string, PlacedNode>();
  const edges: Edge[] = [];
  let width = 0;
  let height = 0;
  root.eachBefore((point) => {
    const { node, children, position } = point.data;
    const placed: PlacedNode = {
      node,
      ...box(point as P),
      depth: point.depth + 1,
      position,
      siblings: point.parent?.data.children.length ?? 1,
      hidden: point.children === undefined ? (sizes.get(node.path) ?? 0) : 0,
      expandable: children.length > 0,
    };
    nodes.push(placed);
    byPath.set(node.path, placed);
    width = Math.max(width, placed.x + placed.width + MARGIN);
    height = Math.max(height, placed.y + placed.height + MARGIN);
    if (point.parent !== null) {
      edges.push({ from: byPath.get(point.parent.data.node.path) as PlacedNode, to: placed });
    }
  });
  return { nodes, edges, width, height };
}

/** What to fold away at first so that about `limit` nodes are shown, with the way to `focus` open. */
export function collapsedAtFirst(
  nodes: readonly TreeNode[],
  limit: number,
  focus: string | null,
): Set<string> {
  const children = new Map<string, number>();
  for (const { path } of nodes) {
    const parent = parentOf(path);
    if (parent !== null) children.set(parent, (children.get(parent) ?? 0) + 1);
  }
  const collapsed = new Set<string>();
  if (nodes.length <= limit) return collapsed;
  const onTheWay = new Set(focus === null ? ["/"] : ["/", ...pathsAbove(focus)]);
  let shown = 1;
  for (const path of onTheWay) shown += children.get(path) ?? 0;
  const byDepth = nodes.map((node) => node.path).sort((a, b) => depthOf(a) - depthOf(b));
  for (const path of byDepth) {
    const under = children.get(path) ?? 0;
    if (under === 0 || onTheWay.has(path)) continue;
    if (!collapsed.has(parentOf(path) as string) && shown + under <= limit) shown += under;
    else collapsed.add(path);
  }
  return collapsed;
}

function depthOf(path: string): number {
  return path === "/" ? 0 : path.split("/").length - 1;
}

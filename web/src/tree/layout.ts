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
  /** How many of its children are left out, being too many to be looked through. */
  leftOut: number;
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

/** Of more children of one node only so many are drawn, those around the one that matters. */
export const MOST_CHILDREN = 200;

interface Branch {
  /** Among the nodes. */
  index: number;
  position: number;
  children: Branch[];
}

/** A tree's shape, from which it is laid out again and again. */
export interface GrownTree {
  root: Branch | null;
  /** How many nodes there are under each node. */
  sizes: readonly number[];
}

/** The shape of a tree, whatever became of its nodes. */
export function growTree(nodes: readonly TreeNode[]): GrownTree {
  const byPath = new Map<string, Branch>();
  const parents: (Branch | undefined)[] = [];
  for (const [index, { path }] of nodes.entries()) {
    const parent = parentOf(path);
    const above = parent === null ? undefined : byPath.get(parent);
    const branch: Branch = { index, position: (above?.children.length ?? 0) + 1, children: [] };
    byPath.set(path, branch);
    parents.push(above);
    above?.children.push(branch);
  }
  const sizes = new Array<number>(nodes.length).fill(0);
  for (let i = nodes.length - 1; i > 0; i--) {
    const above = parents[i];
    if (above !== undefined) sizes[above.index] = (sizes[above.index] as number) + (sizes[i] as number) + 1;
  }
  return { root: byPath.get("/") ?? null, sizes };
}

/** Place the nodes; those under a path of `collapsed` are left out, and most of very many children. */
export function layoutTree(
  nodes: readonly TreeNode[],
  collapsed: ReadonlySet<string>,
  width: number,
  measures: Measures,
  focus: string | null = null,
  grown: GrownTree = growTree(nodes),
): TreeLayout {
  if (grown.root === null) return { direction: "across", nodes: [], edges: [], width: 0, height: 0 };
  const drawn: Drawn = { nodes, sizes: grown.sizes };
  const shown = hierarchy(grown.root, (branch) => {
    const { path } = nodes[branch.index] as TreeNode;
    return collapsed.has(path) ? [] : childrenAround(branch, path, focus);
  });
  const across = acrossLayout(shown, drawn, measures);
  return across.width * SMALLEST_SCALE <= width ? across : downLayout(shown, drawn, width, measures);
}

interface Drawn {
  nodes: readonly TreeNode[];
  sizes: readonly number[];
}

/** The children of a node that are drawn: of very many those around the one that leads to `focus`. */
function childrenAround({ children }: Branch, path: string, focus: string | null): Branch[] {
  if (children.length <= MOST_CHILDREN) return children;
  const under = path === "/" ? "/" : `${path}/`;
  const onTheWay = focus?.startsWith(under) ? Number.parseInt(focus.slice(under.length), 10) || 0 : 0;
  const last = children.length - MOST_CHILDREN;
  const first = Math.min(Math.max(onTheWay - MOST_CHILDREN / 2, 0), last);
  return children.slice(first, first + MOST_CHILDREN);
}

function acrossLayout(root: HierarchyNode<Branch>, drawn: Drawn, measures: Measures): TreeLayout {
  const row = measures.height + measures.rowGap;
  const points = tidyTree<Branch>()
    .nodeSize([row, 1])
    .separation(() => 1)(root);
  const columns = columnsOf(points, drawn, measures);
  let top = 0;
  points.eachBefore((point) => {
    top = Math.min(top, point.x);
  });
  const placed = place(points, drawn, (point, node) => ({
    x: columns[point.depth] as number,
    y: point.x - top + MARGIN,
    width: widthOf(node, measures),
    height: measures.height,
  }));
  return { direction: "across", ...placed };
}

function columnsOf(root: HierarchyNode<Branch>, { nodes }: Drawn, measures: Measures): number[] {
  const widths: number[] = [];
  root.eachBefore(({ depth, data }) => {
    widths[depth] = Math.max(widths[depth] ?? 0, widthOf(nodes[data.index] as TreeNode, measures));
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
  drawn: Drawn,
  width: number,
  measures: Measures,
): TreeLayout {
  const room = width - 2 * MARGIN - measures.leafWidth;
  const indent = Math.max(SMALLEST_INDENT, Math.min(INDENT, room / Math.max(root.height, 1)));
  let row = 0;
  const placed = place(root, drawn, (point, node) => ({
    x: MARGIN + point.depth * indent,
    y: MARGIN + row++ * (measures.height + measures.rowGap),
    width: widthOf(node, measures),
    height: measures.height,
  }));
  return { direction: "down", ...placed };
}

type Box = Pick<PlacedNode, "x" | "y" | "width" | "height">;

function place<P extends HierarchyNode<Branch>>(
  root: P,
  drawn: Drawn,
  box: (point: P, node: TreeNode) => Box,
): Omit<TreeLayout, "direction"> {
  const nodes: PlacedNode[] = [];
  const byIndex = new Map<number, PlacedNode>();
  const edges: Edge[] = [];
  let width = 0;
  let height = 0;
  root.eachBefore((point) => {
    const { index, children, position } = point.data;
    const node = drawn.nodes[index] as TreeNode;
    const shown = point.children?.length ?? 0;
    const placed: PlacedNode = {
      node,
      ...box(point as P, node),
      depth: point.depth + 1,
      position,
      siblings: point.parent?.data.children.length ?? 1,
      hidden: shown === 0 ? (drawn.sizes[index] as number) : 0,
      leftOut: shown === 0 ? 0 : children.length - shown,
      expandable: children.length > 0,
    };
    nodes.push(placed);
    byIndex.set(index, placed);
    width = Math.max(width, placed.x + placed.width + MARGIN);
    height = Math.max(height, placed.y + placed.height + MARGIN);
    if (point.parent !== null) {
      edges.push({ from: byIndex.get(point.parent.data.index) as PlacedNode, to: placed });
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
  for (const path of onTheWay) shown += Math.min(children.get(path) ?? 0, MOST_CHILDREN);
  const byDepth = nodes.map(({ path }) => ({ path, depth: depthOf(path) })).sort((a, b) => a.depth - b.depth);
  for (const { path } of byDepth) {
    const under = children.get(path) ?? 0;
    if (under === 0 || onTheWay.has(path)) continue;
    if (!collapsed.has(parentOf(path) as string) && shown + under <= limit) shown += under;
    else collapsed.add(path);
  }
  return collapsed;
}

function depthOf(path: string): number {
  if (path === "/") return 0;
  let depth = 0;
  for (let at = path.indexOf("/"); at >= 0; at = path.indexOf("/", at + 1)) depth++;
  return depth;
}

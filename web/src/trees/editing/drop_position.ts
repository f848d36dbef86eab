// Which place in a drawn tree a point means.
import type { PlacedNode, TreeLayout } from "../../tree/layout";
import type { Drop } from "./moves";

const NEAR_PX = 40;
/** Of the height of a goal node's card, above and below what means the node itself. */
const EDGE = 0.28;

/** The place that is nearest to a point; null where none is near. The node at `moved` is none. */
export function dropAt(layout: TreeLayout, x: number, y: number, moved: string): Drop | null {
  const others = layout.nodes.filter(({ node }) => !`${node.path}/`.startsWith(`${moved}/`));
  const [nearest] = others
    .map((placed) => ({ placed, away: distance(placed, x, y) }))
    .filter(({ away }) => away <= NEAR_PX)
    .sort((a, b) => a.away - b.away);
  if (nearest === undefined) return null;
  const { node, y: top, height } = nearest.placed;
  const share = (y - top) / height;
  if (node.path === "/") return node.kind === "behavior" ? null : { path: "/", where: "inside" };
  if (node.kind === "behavior") return { path: node.path, where: share < 0.5 ? "before" : "after" };
  if (share < EDGE) return { path: node.path, where: "before" };
  return { path: node.path, where: share > 1 - EDGE ? "after" : "inside" };
}

function distance({ x, y, width, height }: PlacedNode, pointX: number, pointY: number): number {
  return Math.hypot(Math.max(x - pointX, 0, pointX - x - width), Math.max(y - pointY, 0, pointY - y - height));
}

/** The line, or the box around a card, that shows a place. */
export function markOf(layout: TreeLayout, { path, where }: Drop): { x: number; y: number; width: number; height: number } | null {
  const placed = layout.nodes.find(({ node }) => node.path === path);
  if (placed === undefined) return null;
  const { x, y, width, height } = placed;
  if (where === "inside") return { x: x - 4, y: y - 4, width: width + 8, height: height + 8 };
  const below = layout.direction === "across" ? [placed] : layout.nodes.filter(({ node }) => `${node.path}/`.startsWith(`${path}/`));
  const bottom = Math.max(...below.map((each) => each.y + each.height));
  return { x, y: where === "before" ? y - 8 : bottom + 4, width, height: 4 };
}

// What of a large drawing can be seen, and bringing a node there.
import { useEffect, useState } from "preact/hooks";
import type { PlacedNode, TreeLayout } from "./layout";

/** From so many nodes on only those in sight are drawn. */
const MANY = 160;
const BEYOND_SIGHT_PX = 240;

/** In the coordinates of the drawing. */
export interface Sight {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** What can be seen of a drawing at a scale, with some more on each side. */
export function useSight(element: { current: HTMLElement | null }, scale: number): Sight {
  const [sight, setSight] = useState<Sight>({ left: 0, top: 0, right: 4000, bottom: 4000 });
  useEffect(() => {
    const scrolled = element.current;
    if (scrolled === null) return;
    let frame = 0;
    const look = () => {
      frame = 0;
      const { scrollLeft, scrollTop, clientWidth, clientHeight } = scrolled;
      setSight({
        left: (scrollLeft - BEYOND_SIGHT_PX) / scale,
        top: (scrollTop - BEYOND_SIGHT_PX) / scale,
        right: (scrollLeft + clientWidth + BEYOND_SIGHT_PX) / scale,
        bottom: (scrollTop + clientHeight + BEYOND_SIGHT_PX) / scale,
      });
    };
    const soon = () => {
      frame ||= requestAnimationFrame(look);
    };
    look();
    scrolled.addEventListener("scroll", soon, { passive: true });
    return () => {
      scrolled.removeEventListener("scroll", soon);
      cancelAnimationFrame(frame);
    };
  }, [scale]);
  return sight;
}

/** The part of a layout that is to be drawn; the node at `always` is. */
export function inSight(layout: TreeLayout, sight: Sight, always: string | null): Pick<TreeLayout, "nodes" | "edges"> {
  if (layout.nodes.length <= MANY) return layout;
  const near = ({ x, y, width, height }: PlacedNode) =>
    x < sight.right && x + width > sight.left && y < sight.bottom && y + height > sight.top;
  return {
    nodes: layout.nodes.filter((placed) => placed.node.path === always || near(placed)),
    edges: layout.edges.filter(
      ({ from, to }) =>
        Math.min(from.y, to.y) < sight.bottom && Math.max(from.y, to.y) + to.height > sight.top,
    ),
  };
}

/** Bring a node into sight whenever it is another one. */
export function useIntoSight(
  element: { current: HTMLElement | null },
  layout: TreeLayout,
  path: string | null,
  scale: number,
): void {
  const there = layout.nodes.some((placed) => placed.node.path === path);
  useEffect(() => {
    const placed = layout.nodes.find((each) => each.node.path === path);
    if (placed !== undefined && element.current !== null) showWithin(element.current, placed, scale);
  }, [path, there]);
}

/** Scroll the drawing, and nothing around it, until a node is in sight. */
function showWithin(scrolled: HTMLElement, placed: PlacedNode, scale: number): void {
  const { scrollTop, scrollLeft, clientHeight, clientWidth } = scrolled;
  const top = placed.y * scale;
  const bottom = (placed.y + placed.height) * scale;
  if (top < scrollTop || bottom > scrollTop + clientHeight) {
    scrolled.scrollTop = (top + bottom - clientHeight) / 2;
  }
  const left = placed.x * scale;
  const right = (placed.x + placed.width) * scale;
  if (left < scrollLeft || right > scrollLeft + clientWidth) {
    scrolled.scrollLeft = (left + right - clientWidth) / 2;
  }
}

// A task tree as a drawing that can be walked with the arrow keys, zoomed, and folded when large.
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { Edges } from "./edges";
import { COMPACT, collapsedAtFirst, FULL, layoutTree, type PlacedNode, type TreeLayout } from "./layout";
import { NodeCard } from "./node_card";
import { parentOf, pathsAbove, type TreeNode } from "./tree_node";
import { described } from "./words";
import "./tree.css";

const SHOWN_AT_FIRST = 120;
const SHOWN_AT_FIRST_COMPACT = 14;
/** From so many nodes on only those in sight are drawn. */
const MANY = 160;
const BEYOND_SIGHT_PX = 240;
const ZOOM_STEP = 1.25;
const MIN_ZOOM = 0.3;
const MAX_ZOOM = 2.5;

export interface TreeDrawingProps {
  /** Depth first, the root first. */
  nodes: readonly TreeNode[];
  /** What the drawing is called for those who hear it. */
  label?: string;
  /** The path of the selected node. */
  selected?: string | null;
  /** The path of the node that matters now: it is unfolded and brought into sight. */
  focus?: string | null;
  onSelect?: (path: string) => void;
  /** Small cards without figures, for a corner of something else. */
  compact?: boolean;
}

export function TreeDrawing(props: TreeDrawingProps) {
  const { nodes, label = "Task tree", selected = null, focus = null, onSelect, compact = false } = props;
  const scroll = useRef<HTMLDivElement>(null);
  const size = useSize(scroll);
  const [collapsed, setCollapsed] = useCollapsed(nodes, focus, compact);
  const [zoom, setZoom] = useState(1);
  const measures = compact ? COMPACT : FULL;
  const layout = useMemo(
    () => layoutTree(nodes, collapsed, size.width, measures),
    [nodes, collapsed, size.width, measures],
  );
  const scale = Math.min(1, size.width / Math.max(layout.width, 1)) * zoom;
  const sight = useSight(scroll, scale);
  useIntoSight(scroll, layout, focus, scale);
  const toggle = (path: string) => setCollapsed(toggled(collapsed, path));
  const walk = useWalk(layout, selected ?? focus, toggle, onSelect);
  const highest = useMemo(() => Math.max(0, ...nodes.map((node) => node.potential ?? 0)), [nodes]);
  const drawn = inSight(layout, sight, walk.at);
  const foldable = nodes.length > 24 || collapsed.size > 0;
  return (
    <div class={`tree ${compact ? "compact" : ""}`}>
      {!compact && <ZoomButtons zoom={zoom} setZoom={setZoom} />}
      <div class="tree-scroll" ref={scroll}>
        <svg
          role="tree"
          aria-label={label}
          width={layout.width * scale}
          height={layout.height * scale}
          viewBox={`0 0 ${layout.width} ${layout.height}`}
          onKeyDown={walk.onKeyDown}
        >
          <Edges edges={drawn.edges} direction={layout.direction} />
          {drawn.nodes.map((placed) => (
            <g
              key={placed.node.path}
              ref={walk.refOf(placed.node.path)}
              role="treeitem"
              aria-level={placed.depth}
              aria-posinset={placed.position}
              aria-setsize={placed.siblings}
              aria-selected={placed.node.path === selected}
              aria-expanded={placed.expandable ? placed.hidden === 0 : undefined}
              tabindex={placed.node.path === walk.at ? 0 : -1}
              class={`node ${placed.node.kind} ${placed.node.state ?? "defined"}`}
              data-path={placed.node.path}
              data-state={placed.node.state ?? undefined}
              transform={`translate(${placed.x} ${placed.y})`}
              onClick={() => walk.take(placed.node.path)}
            >
              {/* The name, in words; one of its own beside the visible text would contradict that. */}
              <title>{described(placed.node, placed.hidden)}</title>
              <NodeCard placed={placed} highest={highest} compact={compact} />
              {placed.expandable && (foldable || placed.hidden > 0) && (
                <FoldButton placed={placed} layout={layout} onToggle={() => toggle(placed.node.path)} />
              )}
            </g>
          ))}
        </svg>
      </div>
    </div>
  );
}

function ZoomButtons({ zoom, setZoom }: { zoom: number; setZoom: (zoom: number) => void }) {
  const change = (factor: number) => setZoom(Math.min(MAX_ZOOM, Math.max(MIN_ZOOM, zoom * factor)));
  return (
    <div class="tree-zoom" role="group" aria-label="Size of the drawing">
      <button type="button" aria-label="Smaller" disabled={zoom <= MIN_ZOOM} onClick={() => change(1 / ZOOM_STEP)}>
        −
      </button>
      <button type="button" aria-label="Fit the panel" onClick={() => setZoom(1)}>
        Fit
      </button>
      <button type="button" aria-label="Larger" disabled={zoom >= MAX_ZOOM} onClick={() => change(ZOOM_STEP)}>
        +
      </button>
    </div>
  );
}

/** A shortcut for the pointer; the keyboard has the arrow keys for it. */
function FoldButton(props: { placed: PlacedNode; layout: TreeLayout; onToggle: () => void }) {
  const { placed, layout, onToggle } = props;
  const x = layout.direction === "across" ? placed.width + 2 : placed.width + 16;
  const text = placed.hidden > 0 ? `+${placed.hidden}` : "−";
  const width = Math.max(24, text.length * 8 + 8);
  return (
    <g
      class="fold"
      aria-hidden="true"
      transform={`translate(${x} ${placed.height / 2})`}
      onClick={(event) => {
        event.stopPropagation();
        onToggle();
      }}
    >
      <rect x={-4} y={-12} width={width} height={24} rx={12} />
      <text x={width / 2 - 4} y={4}>
        {text}
      </text>
    </g>
  );
}

function toggled(collapsed: ReadonlySet<string>, path: string): Set<string> {
  const next = new Set(collapsed);
  if (!next.delete(path)) next.add(path);
  return next;
}

/** What is folded away: chosen anew for another tree, and never what leads to `focus`. */
function useCollapsed(nodes: readonly TreeNode[], focus: string | null, compact: boolean) {
  const limit = compact ? SHOWN_AT_FIRST_COMPACT : SHOWN_AT_FIRST;
  const shape = useShape(nodes);
  const [collapsed, setCollapsed] = useState<ReadonlySet<string>>(new Set());
  useLayoutEffect(() => setCollapsed(collapsedAtFirst(shape, limit, focus)), [shape, limit]);
  useLayoutEffect(() => {
    const hiding = focus === null ? [] : pathsAbove(focus).filter((path) => collapsed.has(path));
    if (hiding.length === 0) return;
    const open = new Set(collapsed);
    for (const path of hiding) open.delete(path);
    setCollapsed(open);
  }, [focus]);
  return [collapsed, setCollapsed] as const;
}

/** The same array as long as the tree has the same paths, whatever became of its nodes. */
function useShape(nodes: readonly TreeNode[]): readonly TreeNode[] {
  const held = useRef(nodes);
  const same =
    held.current.length === nodes.length &&
    nodes.every((node, index) => node.path === held.current[index]?.path);
  if (!same) held.current = nodes;
  return held.current;
}

function useSize(element: { current: HTMLElement | null }): { width: number } {
  const [size, setSize] = useState({ width: 0 });
  useLayoutEffect(() => {
    const measured = element.current;
    if (measured === null) return;
    const measure = () => setSize({ width: measured.clientWidth });
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(measured);
    return () => observer.disconnect();
  }, []);
  return size;
}

interface Sight {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

function useSight(element: { current: HTMLElement | null }, scale: number): Sight {
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

function inSight(layout: TreeLayout, sight: Sight, always: string | null): Pick<TreeLayout, "nodes" | "edges"> {
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

function useIntoSight(
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

/** One node can be reached with Tab; the arrow keys go on from it as in any tree. */
function useWalk(
  layout: TreeLayout,
  initial: string | null,
  toggle: (path: string) => void,
  onSelect: ((path: string) => void) | undefined,
) {
  const [walked, setWalked] = useState<string | null>(null);
  const elements = useRef(new Map<string, SVGGElement>());
  const goingTo = useRef<string | null>(null);
  const shown = (path: string | null) => layout.nodes.some((placed) => placed.node.path === path);
  const at = shown(walked) ? walked : shown(initial) ? initial : (layout.nodes[0]?.node.path ?? null);
  useLayoutEffect(() => {
    if (at === null || goingTo.current !== at) return;
    goingTo.current = null;
    elements.current.get(at)?.focus();
  }, [at]);
  const go = (path: string | undefined | null) => {
    if (path === undefined || path === null) return;
    goingTo.current = path;
    setWalked(path);
  };
  const take = (path: string) => {
    setWalked(path);
    onSelect?.(path);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const focused = (event.target as Element).getAttribute("data-path");
    const index = layout.nodes.findIndex((placed) => placed.node.path === focused);
    const placed = layout.nodes[index];
    if (placed === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const { path } = placed.node;
    const steps: Record<string, () => void> = {
      ArrowDown: () => go(layout.nodes[index + 1]?.node.path),
      ArrowUp: () => go(layout.nodes[index - 1]?.node.path),
      ArrowRight: () => (placed.hidden > 0 ? toggle(path) : placed.expandable && go(layout.nodes[index + 1]?.node.path)),
      ArrowLeft: () => (placed.expandable && placed.hidden === 0 && index > 0 ? toggle(path) : go(parentOf(path))),
      Home: () => go(layout.nodes[0]?.node.path),
      End: () => go(layout.nodes.at(-1)?.node.path),
      Enter: () => take(path),
      " ": () => take(path),
    };
    const step = steps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    step();
  };
  const refOf = (path: string) => (element: SVGGElement | null) => {
    if (element === null) elements.current.delete(path);
    else elements.current.set(path, element);
  };
  return { at, take, onKeyDown, refOf };
}

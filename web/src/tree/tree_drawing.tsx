// A task tree as a drawing that can be walked with the arrow keys, zoomed, and folded when large.
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { Edges } from "./edges";
import { COMPACT, collapsedAtFirst, FULL, growTree, layoutTree, type PlacedNode, type TreeLayout } from "./layout";
import { NodeCard } from "./node_card";
import { pathsAbove, type TreeNode } from "./tree_node";
import { WrongSign } from "./signs";
import { inSight, useIntoSight, useSight } from "./sight";
import { type GoTo, useWalk } from "./walk";
import { described } from "./words";
import { t } from "../words/words";
import { locale } from "../words/language";
import "./tree.css";

const SHOWN_AT_FIRST = 120;
const SHOWN_AT_FIRST_COMPACT = 14;
const ZOOM_STEP = 1.25;
const MIN_ZOOM = 0.3;
const MAX_ZOOM = 2.5;

const NO_PROBLEMS: ReadonlyMap<string, string> = new Map();

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
  /** Whether a node is selected as soon as the keys come to it. */
  selectsOnFocus?: boolean;
  /** Where the keys are to go on; a new object goes there again. */
  goTo?: GoTo | null;
  /** What is wrong with nodes, by path. */
  problems?: ReadonlyMap<string, string>;
  /** Hears keys at a node first; those that it prevents do nothing else. */
  onKey?: (event: KeyboardEvent, path: string) => void;
  /** What is drawn over the tree, in its coordinates. */
  over?: (layout: TreeLayout) => ComponentChildren;
  /** Small cards without figures, for a corner of something else. */
  compact?: boolean;
}

export function TreeDrawing(props: TreeDrawingProps) {
  const { nodes, label = t("Task tree"), selected = null, focus = null, onSelect, compact = false } = props;
  const { selectsOnFocus = false, goTo = null, problems = NO_PROBLEMS, onKey, over } = props;
  const scroll = useRef<HTMLDivElement>(null);
  const size = useSize(scroll);
  const shape = useShape(nodes);
  const grown = useMemo(() => growTree(shape), [shape]);
  const [collapsed, setCollapsed] = useCollapsed(shape, focus, compact);
  const [zoom, setZoom] = useState(1);
  const measures = compact ? COMPACT : FULL;
  const layout = useMemo(
    () => layoutTree(nodes, collapsed, size.width, measures, selected ?? focus, grown),
    [nodes, collapsed, size.width, measures, selected, focus, grown],
  );
  const scale = Math.min(1, size.width / Math.max(layout.width, 1)) * zoom;
  const sight = useSight(scroll, scale);
  useIntoSight(scroll, layout, focus, scale);
  const toggle = (path: string) => setCollapsed(toggled(collapsed, path));
  const walk = useWalk(layout, selected ?? focus, toggle, onSelect, goTo);
  const onKeyDown = (event: KeyboardEvent) => {
    const path = pathOf(event.target);
    if (path !== null) onKey?.(event, path);
    if (!event.defaultPrevented) walk.onKeyDown(event);
  };
  const onFocusIn = (event: FocusEvent) => {
    const path = pathOf(event.target);
    if (selectsOnFocus && path !== null && path !== selected) onSelect?.(path);
  };
  const highest = useMemo(() => nodes.reduce((most, node) => Math.max(most, node.potential ?? 0), 0), [nodes]);
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
          onKeyDown={onKeyDown}
          onFocusIn={onFocusIn}
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
              class={`node ${placed.node.kind} ${placed.node.state ?? "defined"} ${problems.has(placed.node.path) ? "wrong" : ""}`}
              data-path={placed.node.path}
              data-state={placed.node.state ?? undefined}
              transform={`translate(${placed.x} ${placed.y})`}
              onClick={() => walk.take(placed.node.path)}
            >
              {/* The name, in words; one of its own beside the visible text would contradict that. */}
              <title>{described(placed.node, placed.hidden, placed.leftOut, problems.get(placed.node.path))}</title>
              <NodeCard placed={placed} highest={highest} compact={compact} />
              {problems.has(placed.node.path) && <WrongSign x={placed.width - (placed.node.kind === "behavior" ? 4 : 18)} />}
              {placed.leftOut > 0 && <LeftOut placed={placed} />}
              {placed.expandable && (foldable || placed.hidden > 0) && (
                <FoldButton placed={placed} layout={layout} onToggle={() => toggle(placed.node.path)} />
              )}
            </g>
          ))}
          {over?.(layout)}
        </svg>
      </div>
    </div>
  );
}

function pathOf(target: EventTarget | null): string | null {
  return target instanceof Element ? target.getAttribute("data-path") : null;
}

function ZoomButtons({ zoom, setZoom }: { zoom: number; setZoom: (zoom: number) => void }) {
  const change = (factor: number) => setZoom(Math.min(MAX_ZOOM, Math.max(MIN_ZOOM, zoom * factor)));
  return (
    <div class="tree-zoom" role="group" aria-label={t("Size of the drawing")}>
      <button type="button" aria-label={t("Smaller")} disabled={zoom <= MIN_ZOOM} onClick={() => change(1 / ZOOM_STEP)}>
        −
      </button>
      <button type="button" aria-label={t("Fit the panel")} onClick={() => setZoom(1)}>{t("Fit")}</button>
      <button type="button" aria-label={t("Larger")} disabled={zoom >= MAX_ZOOM} onClick={() => change(ZOOM_STEP)}>
        +
      </button>
    </div>
  );
}

/** How many children of a node are not drawn. */
function LeftOut({ placed }: { placed: PlacedNode }) {
  return (
    <text class="left-out" aria-hidden="true" x={placed.width + 24} y={placed.height - 4}>
      {t("{count} more not drawn", { count: placed.leftOut.toLocaleString(locale) })}
    </text>
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
function useCollapsed(shape: readonly TreeNode[], focus: string | null, compact: boolean) {
  const limit = compact ? SHOWN_AT_FIRST_COMPACT : SHOWN_AT_FIRST;
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

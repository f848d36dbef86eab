// A floor under pointer, wheel and keys: moved, zoomed, and fitted to the room there is.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Box } from "./plan";
import { centred, fitted, moved, type Sight, type Size, zoomed } from "./sight";

const ZOOM_STEP = 1.4;
const KEY_STEP_PX = 60;
const DRAG_PX = 4;
/** A place that is gone to is seen at least so large. */
const NEAR_PX_PER_M = 18;

export interface SightControls {
  readonly sight: Sight;
  zoomIn(): void;
  zoomOut(): void;
  fit(): void;
  show(at: { x: number; y: number }): void;
  readonly handlers: {
    onPointerDown(event: PointerEvent): void;
    onPointerMove(event: PointerEvent): void;
    onPointerUp(event: PointerEvent): void;
    onPointerCancel(event: PointerEvent): void;
    onKeyDown(event: KeyboardEvent): void;
  };
}

/** Until somebody moves it all of the box is seen, however large the view becomes. */
export function useSight(view: { current: HTMLElement | null }, box: Box, size: Size): SightControls {
  const [chosen, setChosen] = useState<{ box: Box; sight: Sight } | null>(null);
  // Another floor begins with all of it.
  const own = chosen !== null && chosen.box === box ? chosen.sight : null;
  const fitting = useMemo(() => fitted(box, size), [box, size.width, size.height]);
  const sight = own ?? fitting;
  const latest = useRef(sight);
  latest.current = sight;
  const choose = (next: Sight) => {
    latest.current = next;
    setChosen({ box, sight: next });
  };
  const zoom = (factor: number, at = { x: size.width / 2, y: size.height / 2 }) =>
    choose(zoomed(latest.current, factor, at, box, size));
  const move = (dx: number, dy: number) => choose(moved(latest.current, dx, dy, box, size));
  const fit = () => setChosen(null);
  useWheel(view, zoom);
  return {
    sight,
    zoomIn: () => zoom(ZOOM_STEP),
    zoomOut: () => zoom(1 / ZOOM_STEP),
    fit,
    show: (at) => choose(centred(at, Math.max(latest.current.scale, NEAR_PX_PER_M), size)),
    handlers: { ...usePointers(move, zoom), onKeyDown: keys(move, zoom, fit) },
  };
}

type Move = (dx: number, dy: number) => void;
type Zoom = (factor: number, at?: { x: number; y: number }) => void;

function keys(move: Move, zoom: Zoom, fit: () => void) {
  const deeds: Readonly<Record<string, () => void>> = {
    ArrowLeft: () => move(KEY_STEP_PX, 0),
    ArrowRight: () => move(-KEY_STEP_PX, 0),
    ArrowUp: () => move(0, KEY_STEP_PX),
    ArrowDown: () => move(0, -KEY_STEP_PX),
    "+": () => zoom(ZOOM_STEP),
    "=": () => zoom(ZOOM_STEP),
    "-": () => zoom(1 / ZOOM_STEP),
    "0": fit,
  };
  return (event: KeyboardEvent) => {
    const deed = event.ctrlKey || event.metaKey || event.altKey ? undefined : deeds[event.key];
    if (deed === undefined) return;
    event.preventDefault();
    deed();
  };
}

/** One pointer moves, two move and zoom. */
function usePointers(move: Move, zoom: Zoom) {
  const down = useRef(new Map<number, { x: number; y: number; moved: boolean }>());
  const up = (event: PointerEvent) => void down.current.delete(event.pointerId);
  return {
    onPointerDown(event: PointerEvent) {
      down.current.set(event.pointerId, { x: event.clientX, y: event.clientY, moved: false });
    },
    onPointerMove(event: PointerEvent) {
      const held = down.current.get(event.pointerId);
      if (held === undefined || event.buttons === 0) return;
      const [dx, dy] = [event.clientX - held.x, event.clientY - held.y];
      if (!held.moved && Math.hypot(dx, dy) < DRAG_PX) return;
      const view = event.currentTarget as HTMLElement;
      if (!held.moved) view.setPointerCapture(event.pointerId);
      const other = [...down.current].find(([id]) => id !== event.pointerId)?.[1];
      down.current.set(event.pointerId, { x: event.clientX, y: event.clientY, moved: true });
      if (other === undefined) {
        move(dx, dy);
        return;
      }
      const before = Math.hypot(held.x - other.x, held.y - other.y);
      const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      const { left, top } = view.getBoundingClientRect();
      const between = { x: (event.clientX + other.x) / 2 - left, y: (event.clientY + other.y) / 2 - top };
      if (before > 0) zoom(after / before, between);
      move(dx / 2, dy / 2);
    },
    onPointerUp: up,
    onPointerCancel: up,
  };
}

/** The wheel scrolls the page until the plan has the focus; with Ctrl, or two fingers, it always zooms. */
function useWheel(view: { current: HTMLElement | null }, zoom: Zoom): void {
  const latest = useRef(zoom);
  latest.current = zoom;
  useEffect(() => {
    const turned = view.current;
    if (turned === null) return;
    const turn = (event: WheelEvent) => {
      if (!event.ctrlKey && !turned.contains(document.activeElement)) return;
      event.preventDefault();
      const { left, top } = turned.getBoundingClientRect();
      latest.current(Math.exp(-event.deltaY / 400), { x: event.clientX - left, y: event.clientY - top });
    };
    turned.addEventListener("wheel", turn, { passive: false });
    return () => turned.removeEventListener("wheel", turn);
  }, [view]);
}

/** How large an element is, as it changes. */
export function useSize(element: { current: HTMLElement | null }): Size {
  const [size, setSize] = useState<Size>({ width: 0, height: 0 });
  useEffect(() => {
    const measured = element.current;
    if (measured === null) return;
    const look = () => setSize({ width: measured.clientWidth, height: measured.clientHeight });
    look();
    const observer = new ResizeObserver(look);
    observer.observe(measured);
    return () => observer.disconnect();
  }, [element]);
  return size;
}

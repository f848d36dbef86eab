// The timeline under a pointer: where it is clicked, dragged, and looked at more closely.
import { useEffect, useRef } from "preact/hooks";
import { type Scale, type Span, within } from "./span";

/** The axis is above the lanes, and so high. */
export const AXIS_PX = 28;
const DRAG_PX = 4;

/** A click goes to its moment; dragging along the axis scrubs, dragging the lanes moves the span. */
export function usePointer(scale: Scale, whole: Span, setSpan: (span: Span | null) => void, onGoTo: (time: number) => void) {
  const held = useRef<{ x: number; from: number; onAxis: boolean; moved: boolean } | null>(null);
  const xOf = (event: PointerEvent | MouseEvent) =>
    event.clientX - (event.currentTarget as Element).getBoundingClientRect().left;
  return {
    onPointerDown(event: PointerEvent) {
      const { top } = (event.currentTarget as Element).getBoundingClientRect();
      held.current = { x: xOf(event), from: scale.from, onAxis: event.clientY - top < AXIS_PX, moved: false };
    },
    onPointerMove(event: PointerEvent) {
      const drag = held.current;
      if (drag === null || event.buttons === 0) return;
      const x = xOf(event);
      if (Math.abs(x - drag.x) < DRAG_PX && !drag.moved) return;
      if (!drag.moved) (event.currentTarget as Element).setPointerCapture(event.pointerId);
      drag.moved = true;
      const length = scale.to - scale.from;
      if (drag.onAxis) onGoTo(scale.time(x));
      else if (length < whole.to) setSpan(within(drag.from - ((x - drag.x) / scale.width) * length, length, whole));
    },
    onClick(event: MouseEvent) {
      const dragged = held.current?.moved === true;
      held.current = null;
      if (!dragged && xOf(event) >= scale.left) onGoTo(scale.time(xOf(event)));
    },
  };
}

/** Ctrl and the wheel, or two fingers, change the span; the wheel alone scrolls the page as ever. */
export function useWheel(element: { current: HTMLElement | null }, zoom: (x: number, factor: number) => void): void {
  const latest = useRef(zoom);
  latest.current = zoom;
  useEffect(() => {
    const turned = element.current;
    if (turned === null) return;
    const turn = (event: WheelEvent) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      latest.current(event.clientX - turned.getBoundingClientRect().left, Math.exp(event.deltaY / 200));
    };
    turned.addEventListener("wheel", turn, { passive: false });
    return () => turned.removeEventListener("wheel", turn);
  }, []);
}

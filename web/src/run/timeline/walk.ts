// Going through the things of a timeline with the keys: one of them has its place in the tab order.
import { useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Lane, TimelineItem } from "./lanes";
import { type Span, within } from "./span";

export type Walk = ReturnType<typeof useWalk>;

/** One thing can be reached with Tab; the arrow keys go on from it along its lane and to the others. */
export function useWalk(lanes: readonly Lane[], span: Span, whole: Span, setSpan: (span: Span | null) => void) {
  const [walked, setWalked] = useState<number | null>(null);
  const elements = useRef(new Map<number, SVGGElement>());
  const goingTo = useRef<number | null>(null);
  const places = useMemo(
    () => new Map(lanes.flatMap((lane, row) => lane.items.map((item, column) => [item.seq, { row, column }] as const))),
    [lanes],
  );
  const first = lanes.flatMap((lane) => lane.items).find((item) => item.end >= span.from)?.seq ?? null;
  const at = walked !== null && places.has(walked) ? walked : first;
  useLayoutEffect(() => {
    if (at === null || goingTo.current !== at) return;
    goingTo.current = null;
    elements.current.get(at)?.focus();
  });
  const walkTo = (item: TimelineItem | undefined) => {
    if (item === undefined) return;
    goingTo.current = item.seq;
    const length = span.to - span.from;
    if (item.start < span.from || item.start > span.to) setSpan(within(item.start - length / 2, length, whole));
    setWalked(item.seq);
  };
  const nearest = (row: number, step: number, time: number): TimelineItem | undefined => {
    for (let other = row + step; other >= 0 && other < lanes.length; other += step) {
      const items = lanes[other]?.items ?? [];
      if (items.length > 0) return items.reduce((a, b) => (Math.abs(b.start - time) < Math.abs(a.start - time) ? b : a));
    }
    return undefined;
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const place = places.get(Number((event.target as Element).getAttribute("data-seq")));
    if (place === undefined) return;
    const items = lanes[place.row]?.items ?? [];
    const item = items[place.column] as TimelineItem;
    const steps: Record<string, () => void> = {
      ArrowRight: () => walkTo(items[place.column + 1]),
      ArrowLeft: () => walkTo(items[place.column - 1]),
      ArrowDown: () => walkTo(nearest(place.row, 1, item.start)),
      ArrowUp: () => walkTo(nearest(place.row, -1, item.start)),
      Home: () => walkTo(items[0]),
      End: () => walkTo(items.at(-1)),
      Enter: () => elements.current.get(item.seq)?.dispatchEvent(new MouseEvent("click", { bubbles: true })),
      " ": () => elements.current.get(item.seq)?.dispatchEvent(new MouseEvent("click", { bubbles: true })),
    };
    const step = steps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    step();
  };
  const refOf = (seq: number) => (element: SVGGElement | null) => {
    if (element === null) elements.current.delete(seq);
    else elements.current.set(seq, element);
  };
  return { at, walkTo: (seq: number) => setWalked(seq), onKeyDown, refOf };
}

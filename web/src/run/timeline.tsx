// The timeline of a run: lanes over its clock, to be looked at closely and to jump from.
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Moment } from "./moment";
import { clock } from "./run_header";
import { type Lane, ticksOf, type TimelineItem } from "./timeline_lanes";
import { TimelineList } from "./timeline_list";

const LABELS_PX = 96;
const NARROW_PX = 560;
const AXIS_PX = 24;
const LANE_PX = 32;
const LANE_NARROW_PX = 44;
const TICK_PX = 80;
const CHARACTER_PX = 6.8;
const SMALLEST_SPAN_S = 1;
/** Steps narrower than this on the average are left out: nobody could tell them apart. */
const STEP_PX = 5;
/** More things than this, each with less room than that, are drawn as one. */
const CROWD = 60;
const CROWDED_PX = 12;

export interface TimelineProps {
  lanes: readonly Lane[];
  /** The newest time known. */
  end: number;
  moment: Moment;
  onChoose: (item: TimelineItem) => void;
}

interface Span {
  from: number;
  to: number;
}

/** From seconds to px and back. */
interface Scale extends Span {
  left: number;
  width: number;
  x(time: number): number;
  time(x: number): number;
}

export function Timeline(props: TimelineProps) {
  const { lanes, end } = props;
  const [span, setSpan] = useState<Span | null>(null);
  const [asList, setAsList] = useState(false);
  const whole: Span = { from: 0, to: Math.max(end, SMALLEST_SPAN_S) };
  const shown = span ?? whole;
  const zoom = (factor: number, around = middleOf(shown, props.moment.time.peek())) => setSpan(zoomed(shown, factor, around, whole));
  return (
    <section class="timeline" aria-label="Timeline">
      <div class="timeline-bar">
        <h2>Timeline</h2>
        <button type="button" class="small-button" aria-pressed={asList} onClick={() => setAsList(!asList)}>
          As a list
        </button>
        <div class="tree-zoom" role="group" aria-label="Span of the timeline">
          <button type="button" aria-label="Longer span" disabled={span === null} onClick={() => zoom(2)}>
            −
          </button>
          <button type="button" aria-label="The whole run" onClick={() => setSpan(null)}>
            Whole
          </button>
          <button
            type="button"
            aria-label="Shorter span"
            disabled={shown.to - shown.from <= SMALLEST_SPAN_S}
            onClick={() => zoom(0.5)}
          >
            +
          </button>
        </div>
      </div>
      {asList ? (
        <TimelineList lanes={lanes} moment={props.moment} onChoose={props.onChoose} />
      ) : (
        <Lanes {...props} span={shown} whole={whole} setSpan={setSpan} zoom={zoom} />
      )}
    </section>
  );
}

function middleOf(span: Span, time: number): number {
  return time >= span.from && time <= span.to ? time : (span.from + span.to) / 2;
}

function zoomed(span: Span, factor: number, around: number, whole: Span): Span | null {
  const length = Math.max((span.to - span.from) * factor, SMALLEST_SPAN_S);
  if (length >= whole.to) return null;
  return within(around - ((around - span.from) / (span.to - span.from)) * length, length, whole);
}

function within(from: number, length: number, whole: Span): Span {
  const begin = Math.min(Math.max(from, 0), Math.max(whole.to - length, 0));
  return { from: begin, to: begin + length };
}

interface LanesProps extends TimelineProps {
  span: Span;
  whole: Span;
  setSpan: (span: Span | null) => void;
  zoom: (factor: number, around?: number) => void;
}

function Lanes(props: LanesProps) {
  const { lanes, span, whole, setSpan, zoom, moment, onChoose } = props;
  const frame = useRef<HTMLDivElement>(null);
  const width = useWidth(frame);
  const narrow = width < NARROW_PX;
  const lanePx = narrow ? LANE_NARROW_PX : LANE_PX;
  const height = AXIS_PX + lanes.length * lanePx;
  const scale = scaleOf(span, narrow ? 0 : LABELS_PX, width);
  const pointer = usePointer(scale, whole, setSpan, moment.goTo);
  useWheel(frame, (x, factor) => zoom(factor, scale.time(x)));
  const walk = useWalk(lanes, span, whole, setSpan);
  return (
    <div class="timeline-frame" ref={frame}>
      <svg
        width={width}
        height={height}
        role="group"
        aria-label="Lanes; the arrow keys go from one thing to the next, Enter goes to its moment"
        onKeyDown={walk.onKeyDown}
        {...pointer}
      >
        <rect class="ground" x={scale.left} y={AXIS_PX} width={scale.width} height={height - AXIS_PX} />
        <Axis scale={scale} height={height} />
        {lanes.map((lane, index) => (
          <g key={lane.name} role="group" aria-label={lane.name} transform={`translate(0 ${AXIS_PX + index * lanePx})`}>
            <line class="lane-line" x1={0} x2={width} y1={0} y2={0} />
            <text class="lane-name" x={narrow ? 4 : 0} y={narrow ? 13 : lanePx / 2 + 5}>
              {lane.name}
            </text>
            <g transform={`translate(0 ${narrow ? 14 : 0})`}>
              <LaneItems lane={lane} scale={scale} height={lanePx - (narrow ? 14 : 0)} walk={walk} onChoose={onChoose} />
            </g>
          </g>
        ))}
        <Playhead scale={scale} moment={moment} height={height} />
      </svg>
    </div>
  );
}

function scaleOf(span: Span, left: number, full: number): Scale {
  const width = Math.max(full - left - 12, 1);
  const perSecond = width / (span.to - span.from);
  return {
    ...span,
    left,
    width,
    x: (time) => left + (time - span.from) * perSecond,
    time: (x) => span.from + (x - left) / perSecond,
  };
}

function Axis({ scale, height }: { scale: Scale; height: number }) {
  const ticks = ticksOf(scale.from, scale.to, scale.width / TICK_PX);
  return (
    <g class="axis" aria-hidden="true">
      {ticks.map((time) => (
        <g key={time} transform={`translate(${scale.x(time)} 0)`}>
          <line y1={AXIS_PX - 4} y2={height} />
          <text y={14} class={scale.x(time) < scale.left + 16 ? "first" : scale.x(time) > scale.left + scale.width - 16 ? "last" : ""}>
            {scale.to - scale.from < 5 ? clock(time) : clock(time).replace(".0", "")}
          </text>
        </g>
      ))}
    </g>
  );
}

/** By itself: it moves while the lanes stand still. */
function Playhead({ scale, moment, height }: { scale: Scale; moment: Moment; height: number }) {
  const time = moment.time.value;
  if (time < scale.from || time > scale.to) return null;
  const x = scale.x(time);
  return (
    <g class="playhead" aria-hidden="true">
      <line x1={x} x2={x} y1={AXIS_PX - 8} y2={height} />
      <path d={`M${x - 6} ${AXIS_PX - 12}h12v5l-6 6-6-6z`} />
    </g>
  );
}

type Walk = ReturnType<typeof useWalk>;

interface LaneItemsProps {
  lane: Lane;
  scale: Scale;
  height: number;
  walk: Walk;
  onChoose: (item: TimelineItem) => void;
}

function LaneItems({ lane, scale, height, walk, onChoose }: LaneItemsProps) {
  const seen = lane.items.filter((item) => item.end >= scale.from && item.start <= scale.to);
  if (seen.length > CROWD && scale.width / seen.length < CROWDED_PX) {
    const walked = seen.find((item) => item.seq === walk.at);
    return (
      <>
        <path class="crowd" d={crowd(seen, scale, height)} />
        {walked !== undefined && <LaneItems lane={{ ...lane, items: [walked] }} {...{ scale, height, walk, onChoose }} />}
      </>
    );
  }
  return (
    <>
      {seen.map((item, index) => {
        const left = Math.max(scale.x(item.start), scale.left);
        const right = Math.min(scale.x(item.end), scale.left + scale.width);
        const next = seen[index + 1];
        const room = (next === undefined ? scale.left + scale.width : scale.x(next.start)) - left;
        return (
          <g
            key={item.seq}
            ref={walk.refOf(item.seq)}
            role="button"
            class={`item ${item.look}`}
            tabindex={item.seq === walk.at ? 0 : -1}
            data-seq={item.seq}
            onClick={(event) => {
              event.stopPropagation();
              walk.walkTo(item.seq);
              onChoose(item);
            }}
          >
            <title>{`${clock(item.start)}: ${item.title}`}</title>
            {lane.kind === "steps" || lane.kind === "dialogues" ? (
              <Bar item={item} left={left} right={right} height={height} scale={scale} />
            ) : (
              <Mark item={item} x={left} height={height} room={room} />
            )}
          </g>
        );
      })}
    </>
  );
}

/** Things too many to be told apart, as one shape; a click on it goes to its time. */
function crowd(items: readonly TimelineItem[], scale: Scale, height: number): string {
  const top = 6;
  return items
    .map((item) => {
      const width = Math.max(scale.x(item.end) - scale.x(item.start) - 0.5, 1);
      return `M${scale.x(item.start).toFixed(1)} ${top}h${width.toFixed(1)}v${height - 2 * top}h${-width.toFixed(1)}z`;
    })
    .join("");
}

interface BarProps {
  item: TimelineItem;
  left: number;
  right: number;
  height: number;
  scale: Scale;
}

function Bar({ item, left, right, height, scale }: BarProps) {
  const width = Math.max(right - left, 3);
  const characters = Math.floor((width - 10) / CHARACTER_PX);
  const steps = width / Math.max(item.parts.length, 1) >= STEP_PX ? item.parts : [];
  return (
    <>
      <rect class="body" x={left} y={4} width={width} height={height - 8} rx={4} />
      {steps.slice(1).map((step) => {
        const x = scale.x(step.start);
        return x > left && x < right && <line key={step.seq} class="step-line" x1={x} x2={x} y1={height - 10} y2={height - 4} />;
      })}
      {characters >= 3 && (
        <text x={left + 6} y={height / 2 + 4}>
          {item.word.length > characters ? `${item.word.slice(0, characters - 1)}…` : item.word}
        </text>
      )}
      <rect class="ring" x={left} y={4} width={width} height={height - 8} rx={4} />
    </>
  );
}

function Mark({ item, x, height, room }: { item: TimelineItem; x: number; height: number; room: number }) {
  const y = height / 2;
  const d = item.look === "fault"
    ? `M${x} ${y - 8}l8 15h-16z`
    : item.look === "resolution"
      ? `M${x - 7} ${y}a7 7 0 1 0 14 0a7 7 0 1 0-14 0`
      : `M${x} ${y - 8}l8 8-8 8-8-8z`;
  const wordPx = item.word.length * CHARACTER_PX;
  const worded = room > wordPx + 24;
  return (
    <>
      <rect class="hit" x={x - 12} y={0} width={24 + (worded ? wordPx : 0)} height={height} />
      <path class="body" d={d} />
      {worded && (
        <text x={x + 13} y={y + 4}>
          {item.word}
        </text>
      )}
      <circle class="ring" cx={x} cy={y} r={12} />
    </>
  );
}

function useWidth(element: { current: HTMLElement | null }): number {
  const [width, setWidth] = useState(0);
  useLayoutEffect(() => {
    const measured = element.current;
    if (measured === null) return;
    const measure = () => setWidth(measured.clientWidth);
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(measured);
    return () => observer.disconnect();
  }, []);
  return width;
}

const DRAG_PX = 4;

/** A click goes to its moment; dragging along the axis scrubs, dragging the lanes moves the span. */
function usePointer(scale: Scale, whole: Span, setSpan: (span: Span | null) => void, onGoTo: (time: number) => void) {
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
function useWheel(element: { current: HTMLElement | null }, zoom: (x: number, factor: number) => void): void {
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

/** One thing can be reached with Tab; the arrow keys go on from it along its lane and to the others. */
function useWalk(lanes: readonly Lane[], span: Span, whole: Span, setSpan: (span: Span | null) => void) {
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

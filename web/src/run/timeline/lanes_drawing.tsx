// The lanes of a timeline as a drawing over the run's clock.
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Moment } from "../moment";
import { shortened, withoutRun } from "../../tree/words";
import { clock } from "../run_words";
import { LaneItems } from "./lane_items";
import { type Lane, ticksOf, type TimelineItem } from "./lanes";
import { AXIS_PX, usePointer, useWheel } from "./pointer";
import { type Scale, scaleOf, type Span } from "./span";
import { useWalk } from "./walk";
import { t } from "../../words/words";

const LABEL = t("Lanes; the arrow keys go from one thing to the next, Enter goes to its moment");
const LABELS_PX = 96;
const NAME_CHARACTERS = 12;
const NARROW_PX = 560;
const LANE_PX = 32;
const LANE_NARROW_PX = 44;
const TICK_PX = 80;

interface LanesProps {
  label?: string;
  /** What is drawn over the lanes; `middle` is that of a lane, in px from the top. */
  overlay?: (scale: Scale, middle: (lane: number) => number, height: number) => ComponentChildren;
  lanes: readonly Lane[];
  moment: Moment;
  onChoose: (item: TimelineItem) => void;
  span: Span;
  whole: Span;
  setSpan: (span: Span | null) => void;
  zoom: (factor: number, around?: number) => void;
}

export function Lanes(props: LanesProps) {
  const { lanes, span, whole, setSpan, zoom, moment, onChoose, label = LABEL, overlay } = props;
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
        aria-label={label}
        onKeyDown={walk.onKeyDown}
        {...pointer}
      >
        <rect class="ground" x={scale.left} y={AXIS_PX} width={scale.width} height={height - AXIS_PX} />
        <Axis scale={scale} height={height} />
        {lanes.map((lane, index) => (
          <g key={lane.name} role="group" aria-label={lane.name} transform={`translate(0 ${AXIS_PX + index * lanePx})`}>
            <line class="lane-line" x1={0} x2={width} y1={0} y2={0} />
            <text class="lane-name" x={narrow ? 4 : 0} y={narrow ? 13 : lanePx / 2 + 5}>
              {shortened(withoutRun(lane.name), NAME_CHARACTERS)}
            </text>
            <g transform={`translate(0 ${narrow ? 14 : 0})`}>
              <LaneItems lane={lane} scale={scale} height={lanePx - (narrow ? 14 : 0)} walk={walk} onChoose={onChoose} />
            </g>
          </g>
        ))}
        {overlay?.(scale, (lane) => AXIS_PX + (lane + 0.5) * lanePx + (narrow ? 7 : 0), height)}
        <Playhead scale={scale} moment={moment} height={height} />
      </svg>
    </div>
  );
}

function Axis({ scale, height }: { scale: Scale; height: number }) {
  const ticks = ticksOf(scale.from, scale.to, scale.width / TICK_PX);
  return (
    <g class="axis" aria-hidden="true">
      {ticks.map((time) => (
        <g key={time} transform={`translate(${scale.x(time)} 0)`}>
          <line y1={AXIS_PX - 4} y2={height} />
          <text y={12} class={scale.x(time) < scale.left + 16 ? "first" : scale.x(time) > scale.left + scale.width - 16 ? "last" : ""}>
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

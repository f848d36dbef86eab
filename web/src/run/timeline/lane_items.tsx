// The things on one lane: bars for what takes time, marks for what happens at once.
import { clock } from "../run_words";
import type { Lane, LaneKind, TimelineItem } from "./lanes";
import type { Scale } from "./span";
import type { Walk } from "./walk";

const CHARACTER_PX = 6.8;
/** Steps narrower than this on the average are left out: nobody could tell them apart. */
const STEP_PX = 5;
/** More things than this, each with less room than that, are drawn as one. */
const CROWD = 60;
const CROWDED_PX = 12;

/** What is on these lanes takes time. */
const BARS: ReadonlySet<LaneKind> = new Set<LaneKind>(["steps", "lost", "dialogues", "waits"]);

interface LaneItemsProps {
  lane: Lane;
  scale: Scale;
  height: number;
  walk: Walk;
  onChoose: (item: TimelineItem) => void;
}

export function LaneItems({ lane, scale, height, walk, onChoose }: LaneItemsProps) {
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
            {BARS.has(lane.kind) ? (
              <Bar item={item} left={left} right={right} room={room} height={height} scale={scale} />
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
  /** Until the next one begins, which may be before this one ends. */
  room: number;
  height: number;
  scale: Scale;
}

function Bar({ item, left, right, room, height, scale }: BarProps) {
  const width = Math.max(right - left, 3);
  const characters = Math.floor((Math.min(width, room) - 10) / CHARACTER_PX);
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

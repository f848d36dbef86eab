// A scene seen from above: the table, parts and where they go, robots and how far they reach. Things are dragged.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { RobotReach } from "../wire/types";
import { type Dragging, follow } from "./dragging";
import type { SceneSource, Thing } from "./scene_source";
import { resizedTo, shownWith, type ThingChange, turnedTo } from "./thing_change";
import { ThingDrawing } from "./thing_drawing";
import { ThingHandles } from "./thing_handles";
import { keyOf, type ThingProblem } from "./thing_problems";
import { viewFrame, type ViewFrame } from "./view_frame";
import { t } from "../words/words";

/** So that the form below it is in sight, too. */
const MOST_OF_WINDOW = 0.5;
const SMALLEST_HEIGHT_PX = 280;

interface TopViewProps {
  source: SceneSource;
  selected: string;
  reach: readonly RobotReach[];
  problems: ReadonlyMap<string, readonly ThingProblem[]>;
  onSelect: (key: string) => void;
  onChange: (thing: Thing, change: ThingChange) => void;
  onKey: (event: KeyboardEvent, thing: Thing) => void;
}

interface Drag {
  thing: Thing;
  change: ThingChange;
}

export function TopView({ source, selected, reach, problems, onSelect, onChange, onKey }: TopViewProps) {
  const box = useRef<HTMLDivElement>(null);
  const drawing = useRef<SVGSVGElement>(null);
  const width = useWidth(box);
  const frame = viewFrame(source, width, Math.max(SMALLEST_HEIGHT_PX, innerHeight * MOST_OF_WINDOW));
  const [drag, setDrag] = useState<Drag | null>(null);
  const at = ({ clientX, clientY }: Dragging) => {
    const { left, top } = (drawing.current as SVGSVGElement).getBoundingClientRect();
    return frame.at(clientX - left, clientY - top);
  };
  const grab = (event: PointerEvent, thing: Thing, changed: (to: Dragging) => ThingChange) => {
    onSelect(keyOf(thing));
    if (event.button !== 0 || thing.where === null) return;
    const end = (to: Dragging | null) => {
      setDrag(null);
      if (to !== null) onChange(thing, changed(to));
    };
    follow(event, (to) => setDrag({ thing, change: changed(to) }), end);
  };
  const moving = (event: PointerEvent, thing: Thing) => {
    const from = at(event);
    grab(event, thing, (to) => ({ pose: { x: thing.pose.x + at(to).x - from.x, y: thing.pose.y + at(to).y - from.y } }));
  };
  const shown = (thing: Thing) => (drag === null ? thing : shownWith(thing, drag.thing, drag.change));
  // What is selected is drawn last, over the others.
  const things = [...source.things].sort((a, b) => Number(keyOf(a) === selected) - Number(keyOf(b) === selected));
  const last = things.at(-1);
  return (
    <div class="top-view" ref={box}>
      {width > 0 && (
        <svg ref={drawing} width={frame.width} height={frame.height} role="group" aria-label={t("The scene from above")} aria-describedby="scene-keys">
          <Ground frame={frame} table={source.table} reach={reach} />
          {things.map((thing) => (
            <ThingDrawing
              key={keyOf(thing)}
              thing={shown(thing)}
              frame={frame}
              selected={keyOf(thing) === selected}
              problems={problems.get(keyOf(thing)) ?? []}
              onGrab={(event) => moving(event, thing)}
              onKey={(event) => onKey(event, thing)}
              onFocus={() => onSelect(keyOf(thing))}
            />
          ))}
          {last !== undefined && last.where !== null && keyOf(last) === selected && (
            <ThingHandles
              thing={shown(last)}
              frame={frame}
              onTurn={(event) => grab(event, last, (to) => turnedTo(last, at(to), to.shiftKey))}
              onResize={(event) => grab(event, last, (to) => resizedTo(last, at(to)))}
            />
          )}
        </svg>
      )}
    </div>
  );
}

function Ground({ frame, table, reach }: { frame: ViewFrame; table: SceneSource["table"]; reach: readonly RobotReach[] }) {
  const [x = 0, y = 0] = table.center;
  const [depth = 0, width = 0] = table.size;
  return (
    <g aria-hidden="true">
      <rect
        class="table"
        x={frame.left(y + width / 2)}
        y={frame.top(x + depth / 2)}
        width={width * frame.scale}
        height={depth * frame.scale}
        rx={3}
      />
      {reach.map(({ robot, x: from, y: beside, min_m, max_m }) => (
        <g key={robot} class="reach">
          <circle class="beyond" cx={frame.left(beside)} cy={frame.top(from)} r={max_m * frame.scale} />
          <circle class="within" cx={frame.left(beside)} cy={frame.top(from)} r={min_m * frame.scale} />
        </g>
      ))}
    </g>
  );
}

function useWidth(box: { current: HTMLDivElement | null }): number {
  const [width, setWidth] = useState(0);
  useLayoutEffect(() => {
    const element = box.current as HTMLDivElement;
    const measure = () => setWidth(element.clientWidth);
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  return width;
}

// A scene seen from above: the table, parts and where they go, robots and how far they reach. Things are dragged.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { RobotReach } from "../wire/types";
import { plain, shortened } from "../tree/words";
import { keyOf, type ThingProblem } from "./thing_problems";
import type { Pose, SceneSource, Thing } from "./scene_source";
import { placed, screenColor, viewFrame, type ViewFrame } from "./view_frame";
import { t } from "../words/words";

const LETTER_PX = 7;
const LINE_PX = 16;
const BEGINS_PX = 3;
/** So that the form below it is in sight, too. */
const MOST_OF_WINDOW = 0.5;
const SMALLEST_HEIGHT_PX = 280;
/** A thing that is smaller can still be grabbed. */
const SMALLEST_PX = 24;

interface TopViewProps {
  source: SceneSource;
  selected: string;
  reach: readonly RobotReach[];
  problems: ReadonlyMap<string, readonly ThingProblem[]>;
  onSelect: (key: string) => void;
  onMove: (thing: Thing, change: Partial<Pose>) => void;
  onKey: (event: KeyboardEvent, thing: Thing) => void;
}

interface Drag {
  thing: Thing;
  /** From where it was, in metres. */
  x: number;
  y: number;
}

export function TopView({ source, selected, reach, problems, onSelect, onMove, onKey }: TopViewProps) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const frame = viewFrame(source, width, Math.max(SMALLEST_HEIGHT_PX, innerHeight * MOST_OF_WINDOW));
  const [drag, setDrag] = useState<Drag | null>(null);
  const { table } = source;
  const grab = (event: PointerEvent, thing: Thing) => {
    onSelect(keyOf(thing));
    if (event.button !== 0 || thing.where === null) return;
    dragged(event, frame.scale, (x, y) => setDrag({ thing, x, y })).then((by) => {
      setDrag(null);
      if (by !== null) onMove(thing, { x: thing.pose.x + by.x, y: thing.pose.y + by.y });
    });
  };
  // What is selected is drawn last, over the others.
  const things = [...source.things].sort((a, b) => Number(keyOf(a) === selected) - Number(keyOf(b) === selected));
  return (
    <div class="top-view" ref={box}>
      {width > 0 && (
        <svg width={frame.width} height={frame.height} role="group" aria-label={t("The scene from above")} aria-describedby="scene-keys">
          <Ground frame={frame} table={table} reach={reach} />
          {things.map((thing) => (
            <ThingDrawing
              key={keyOf(thing)}
              thing={shownOf(thing, drag)}
              frame={frame}
              selected={keyOf(thing) === selected}
              problems={problems.get(keyOf(thing)) ?? []}
              onGrab={(event) => grab(event, thing)}
              onKey={(event) => onKey(event, thing)}
              onFocus={() => onSelect(keyOf(thing))}
            />
          ))}
        </svg>
      )}
    </div>
  );
}

/** A thing where it is dragged to, with those that move with it. */
function shownOf(thing: Thing, drag: Drag | null): Thing {
  if (drag === null || thing.where === null || thing.where.join("/") !== drag.thing.where?.join("/")) return thing;
  return { ...thing, pose: { ...thing.pose, x: thing.pose.x + drag.x, y: thing.pose.y + drag.y } };
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

interface ThingDrawingProps {
  thing: Thing;
  frame: ViewFrame;
  selected: boolean;
  problems: readonly ThingProblem[];
  onGrab: (event: PointerEvent) => void;
  onKey: (event: KeyboardEvent) => void;
  onFocus: () => void;
}

function ThingDrawing({ thing, frame, selected, problems, onGrab, onKey, onFocus }: ThingDrawingProps) {
  const { kind, pose } = thing;
  const [depth, width] = thing.size ?? [0.05, 0.05];
  const [high, wide] = [(depth ?? 0) * frame.scale, (width ?? 0) * frame.scale];
  const wrong = problems.length === 0 ? "" : problems.some(({ mistake }) => mistake) ? "wrong" : "doubtful";
  const [room, tall] = [Math.max(wide, SMALLEST_PX), Math.max(high, SMALLEST_PX)];
  return (
    <g
      class={`thing ${kind} ${wrong} ${selected ? "selected" : ""}`}
      data-thing={keyOf(thing)}
      role="button"
      aria-pressed={selected}
      tabindex={selected ? 0 : -1}
      onPointerDown={onGrab}
      onKeyDown={onKey}
      onFocus={onFocus}
    >
      <title>{describedThing(thing, problems)}</title>
      <g transform={placed(frame, pose)}>
        <rect class="hand" x={-room / 2} y={-tall / 2} width={room} height={tall} />
        {kind === "robot" ? (
          <path class="body" d="M-14 16V-6L0 -18L14 -6V16Z" />
        ) : (
          <rect class="body" x={-wide / 2} y={-high / 2} width={wide} height={high} rx={2} fill={kind === "object" ? screenColor(thing.color) : "none"} />
        )}
        {kind === "place" && <path class="middle" d="M-4 0H4M0 -4V4" />}
      </g>
      <ThingName thing={thing} frame={frame} wide={wide} high={high} always={selected} />
      {wrong !== "" && (
        <g class="thing-sign" aria-hidden="true" transform={`translate(${frame.left(pose.y) + wide / 2} ${frame.top(pose.x) - high / 2})`}>
          <circle r={8} />
          <path d="M0 -4v4.5M0 3.5v.5" />
        </g>
      )}
    </g>
  );
}

/** The name where it has room; of what is selected always. */
function ThingName(props: { thing: Thing; frame: ViewFrame; wide: number; high: number; always: boolean }) {
  const { thing, frame, wide, high, always } = props;
  const { kind, pose } = thing;
  const across = Math.abs(Math.sin(pose.yaw)) > Math.SQRT1_2;
  const letters = kind === "robot" ? 14 : Math.floor((across ? high : wide) / LETTER_PX);
  const name = always ? plain(thing.name) : kind === "place" ? "" : shortened(plain(thing.name), letters);
  if (name === "") return null;
  const half = (name.length * LETTER_PX) / 2;
  const middle = Math.min(Math.max(frame.left(pose.y), half), frame.width - half);
  return (
    <text class="thing-name" x={middle} y={frame.top(pose.x) + (kind === "robot" ? 32 : below(across ? wide : high))} aria-hidden="true">
      {name}
    </text>
  );
}

/** In the middle of what is high enough, else under it. */
function below(high: number): number {
  return high < LINE_PX ? high / 2 + LINE_PX - 4 : 4;
}

const KINDS: Readonly<Record<Thing["kind"], string>> = { object: t("part"), place: t("place"), robot: t("robot") };

function describedThing({ kind, name, pose }: Thing, problems: readonly ThingProblem[]): string {
  const told = t("{name}, {kinds}, at {x}, {y}", { name: plain(name), kinds: KINDS[kind], x: pose.x.toFixed(3), y: pose.y.toFixed(3) });
  return [told, ...problems.map(({ message, mistake }) => `${mistake ? t("Mistake:") : ""}${message}`)].join(". ");
}

/** Follow a pointer until it lets go: by how much in metres; null where it hardly moved or gave up. */
function dragged(begun: PointerEvent, scale: number, onWay: (x: number, y: number) => void): Promise<{ x: number; y: number } | null> {
  const by = ({ clientX, clientY }: PointerEvent) => ({ x: (begun.clientY - clientY) / scale, y: (begun.clientX - clientX) / scale });
  let begins = false;
  const ended = new AbortController();
  const { signal } = ended;
  return new Promise((resolve) => {
    const end = (result: { x: number; y: number } | null) => {
      ended.abort();
      resolve(result);
    };
    addEventListener("pointermove", (event) => {
      begins ||= Math.hypot(event.clientX - begun.clientX, event.clientY - begun.clientY) >= BEGINS_PX;
      if (begins) onWay(by(event).x, by(event).y);
    }, { signal });
    addEventListener("pointerup", (event) => end(begins ? by(event) : null), { signal });
    addEventListener("pointercancel", () => end(null), { signal });
    addEventListener("keydown", (event) => event.key === "Escape" && end(null), { signal });
  });
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

// One thing of a scene from above: its outline, its name, and a sign where something is wrong with it.
import { plain, shortened } from "../tree/words";
import { screenColor } from "./colors";
import type { Thing } from "./scene_source";
import { keyOf, type ThingProblem } from "./thing_problems";
import { placed, type ViewFrame } from "./view_frame";
import { t } from "../words/words";

const LETTER_PX = 7;
const LINE_PX = 16;
/** A thing that is smaller can still be grabbed. */
const SMALLEST_PX = 24;

interface ThingDrawingProps {
  thing: Thing;
  frame: ViewFrame;
  selected: boolean;
  problems: readonly ThingProblem[];
  onGrab: (event: PointerEvent) => void;
  onKey: (event: KeyboardEvent) => void;
  onFocus: () => void;
}

export function ThingDrawing({ thing, frame, selected, problems, onGrab, onKey, onFocus }: ThingDrawingProps) {
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

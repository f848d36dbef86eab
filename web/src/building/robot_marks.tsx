// The robots on a floor: each at its pose, with its name, and a line to where it drives.
// They are moved here without the rest of the page hearing of it.
import type { Ref } from "preact";
import { useImperativeHandle, useRef } from "preact/hooks";
import { ACTIVITY_SIGNS, type AtWork, type Goal } from "./at_work";
import { type Named, placeLabels, type Rect } from "./labels";
import type { Plan, PlanFloor } from "./plan";
import type { SeenRobot } from "./seen_robots";
import { drawnAt, type Sight, type Size } from "./sight";
import { likelyEllipse } from "./likely_ellipse";
import type { Standing } from "./standing";
import type { Positions } from "./use_robots";
import { floorShownAt } from "./whereabouts";

export const RADIUS_M = 0.25;
const LEAST_RADIUS_PX = 9;
const LABELS_EVERY_MS = 300;
/** Where there is less of the plan to each robot, as on a phone, only those that ask say more than their name, and others are named where there is room: the list below has all. */
const ROOM_PX2 = 12_000;

export interface Marks {
  draw(positions: Positions): void;
}

interface RobotMarksProps {
  plan: Plan;
  floor: PlanFloor;
  sight: Sight;
  size: Size;
  robots: readonly AtWork[];
  seen: readonly SeenRobot[];
  marks: Ref<Marks>;
  /** Hears which boxes of the view the robots and their names take up. */
  onTaken(boxes: readonly Rect[]): void;
}

export function RobotMarks(props: RobotMarksProps) {
  const { robots, seen, floor, marks } = props;
  const svg = useRef<SVGSVGElement>(null);
  const names = useRef<HTMLDivElement>(null);
  const latest = useRef(props);
  latest.current = props;
  const layer = useRef<ReturnType<typeof createLayer> | null>(null);
  layer.current ??= createLayer();
  useImperativeHandle(marks, () => ({
    draw(positions) {
      if (svg.current !== null && names.current !== null) {
        layer.current?.draw(latest.current, positions, svg.current, names.current);
      }
    },
  }));
  const stateOf = ({ robot, lost }: AtWork) => {
    const found = seen.find((each) => each.robot === robot);
    return found === undefined || found.unseen !== null || lost ? "not-seen" : found.activity;
  };
  return (
    <>
      <svg class="plan-robots-drawing" aria-hidden="true" ref={svg}>
        {robots.map((each) => (
          <g key={each.robot} class={`plan-robot robot-${stateOf(each)}`} data-robot={each.robot} data-floor={floor.name}>
            <ellipse class="plan-unsure" />
            <line class="plan-way" />
            <g class="plan-mark">
              <circle r={1} />
              <path d="M0.75 0L-0.35 0.5L-0.1 0L-0.35 -0.5Z" />
            </g>
          </g>
        ))}
        {robots.map(({ robot, goal }) =>
          goal !== null && goal.floor === floor.name ? <circle key={robot} class="plan-goal" data-goal={robot} r={7} /> : null,
        )}
      </svg>
      <div class="plan-robot-names" aria-hidden="true" ref={names}>
        {robots.map((each) => {
          const state = stateOf(each);
          const found = seen.find(({ robot }) => robot === each.robot);
          return (
            <div key={each.robot} class={`plan-robot-name robot-${state}`} data-robot={each.robot}>
              <b>
                {state === "not-seen" ? "✕" : ACTIVITY_SIGNS[state]} {each.name}
              </b>
              {found !== undefined && found.short !== "" && <span>{found.short}</span>}
            </div>
          );
        })}
      </div>
    </>
  );
}

/** What is remembered from one drawing to the next: where names were, and when they were laid out. */
function createLayer() {
  const offsets = new Map<string, { dx: number; dy: number }>();
  let laidOut = -Infinity;
  let floorBefore = "";

  function draw(props: RobotMarksProps, positions: Positions, svg: SVGSVGElement, names: HTMLElement): void {
    const { plan, floor, sight, size, robots, onTaken } = props;
    const radius = Math.max(RADIUS_M * sight.scale, LEAST_RADIUS_PX);
    const shown = robots.flatMap(({ robot, goal }, index) => {
      const standing = positions.get(robot);
      const here = standing !== undefined && floorShownAt(plan, standing.z) === floor;
      const at = here ? drawnAt(sight, standing.x, standing.y) : null;
      drawMark(svg.children[index] as SVGGElement, at, standing, radius, goal, floor, sight);
      const name = names.children[index] as HTMLElement;
      const away = at === null || at.x < 0 || at.y < 0 || at.x > size.width || at.y > size.height;
      if (name.hidden !== away) name.hidden = away;
      return away ? [] : [{ robot, at, name }];
    });
    for (const goal of svg.querySelectorAll<SVGCircleElement>(".plan-goal")) drawGoal(goal, robots, sight);
    const now = performance.now();
    const boxes = shown.map(({ at }) => around(at, radius));
    if (now - laidOut >= LABELS_EVERY_MS || floorBefore !== floor.name || shown.some(({ robot }) => !offsets.has(robot))) {
      laidOut = now;
      floorBefore = floor.name;
      const crowded = size.width * size.height < shown.length * ROOM_PX2;
      names.classList.toggle("crowded", crowded);
      const asks = (name: HTMLElement) => name.classList.contains("robot-asking");
      const askingFirst = shown.toSorted((a, b) => Number(asks(b.name)) - Number(asks(a.name)));
      const named = askingFirst.map(({ robot, at, name }): Named => {
        const { offsetWidth: width, offsetHeight: height } = name;
        const always = !crowded || asks(name);
        return { id: robot, ...at, clear: radius, width, height, always, before: offsets.get(robot) };
      });
      const bounds = { left: 0, top: 0, right: size.width, bottom: size.height };
      const placed = placeLabels(named, boxes, bounds);
      for (const { robot, at, name } of shown) {
        const spot = placed.get(robot);
        name.classList.toggle("without-room", spot === undefined);
        if (spot !== undefined) offsets.set(robot, { dx: spot.left - at.x, dy: spot.top - at.y });
      }
      const taken = named.flatMap(({ id, width, height }) => {
        const spot = placed.get(id);
        return spot === undefined ? [] : [{ ...spot, right: spot.left + width, bottom: spot.top + height }];
      });
      onTaken([...boxes, ...taken]);
    }
    for (const { robot, at, name } of shown) {
      const { dx, dy } = offsets.get(robot) ?? { dx: 0, dy: 0 };
      const there = `translate(${(at.x + dx).toFixed(1)}px, ${(at.y + dy).toFixed(1)}px)`;
      if (name.style.transform !== there) name.style.transform = there;
    }
  }
  return { draw };
}

function drawMark(
  group: SVGGElement,
  at: { x: number; y: number } | null,
  standing: Standing | undefined,
  radius: number,
  goal: Goal | null,
  floor: PlanFloor,
  sight: Sight,
): void {
  show(group, at !== null);
  if (at === null || standing === undefined) return;
  const [unsure, way, mark] = group.children as unknown as [SVGEllipseElement, SVGLineElement, SVGGElement];
  drawUnsure(unsure, at, standing.covariance ?? null, sight.scale);
  const degrees = (-standing.yaw * 180) / Math.PI;
  const turned = `rotate(${degrees.toFixed(1)}) scale(${radius.toFixed(2)})`;
  put(mark, "transform", `translate(${at.x.toFixed(1)} ${at.y.toFixed(1)}) ${turned}`);
  const there = goal !== null && goal.floor === floor.name ? drawnAt(sight, goal.x, goal.y) : null;
  show(way, there !== null);
  if (there === null) return;
  const ends = { x1: at.x, y1: at.y, x2: there.x, y2: there.y };
  for (const [end, value] of Object.entries(ends)) put(way, end, value.toFixed(1));
}

/** Within it the robot is with a chance of 95 %, as it says itself. */
function drawUnsure(ellipse: SVGEllipseElement, at: { x: number; y: number }, covariance: readonly number[] | null, scale: number): void {
  show(ellipse, covariance !== null);
  if (covariance === null) return;
  const { rx, ry, degrees } = likelyEllipse(covariance);
  put(ellipse, "rx", (rx * scale).toFixed(1));
  put(ellipse, "ry", (ry * scale).toFixed(1));
  // Upwards is up in the plan, and down in the drawing.
  put(ellipse, "transform", `translate(${at.x.toFixed(1)} ${at.y.toFixed(1)}) rotate(${(-degrees).toFixed(1)})`);
}

function drawGoal(mark: SVGCircleElement, robots: readonly AtWork[], sight: Sight): void {
  const goal = robots.find(({ robot }) => robot === mark.dataset.goal)?.goal;
  if (goal === undefined || goal === null) return;
  const { x, y } = drawnAt(sight, goal.x, goal.y);
  put(mark, "cx", x.toFixed(1));
  put(mark, "cy", y.toFixed(1));
}

/** What is the same is left alone: the browser would draw it once more. */
function put(element: Element, attribute: string, value: string): void {
  if (element.getAttribute(attribute) !== value) element.setAttribute(attribute, value);
}

function show(element: Element, shown: boolean): void {
  put(element, "display", shown ? "inline" : "none");
}

function around({ x, y }: { x: number; y: number }, radius: number): Rect {
  return { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius };
}

// The building of a run: one floor at a time, the robots on it at the moment that is shown.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { RunState } from "../run/fold";
import type { Moment } from "../run/moment";
import { createPoseSource, type PoseSource } from "../run/scene/pose_source";
import { helperName } from "../state/preferences";
import { robotsAtWork } from "./at_work";
import { FLOOR_PANEL, FloorTabs, floorTab } from "./floor_tabs";
import { FloorDrawing, FloorLegend } from "./floor_drawing";
import type { Rect } from "./labels";
import { namesHidden, PlaceNames, useNames } from "./place_names";
import type { Plan } from "./plan";
import { RobotList } from "./robot_list";
import { type Marks, RobotMarks } from "./robot_marks";
import type { SeenRobot } from "./seen_robots";
import { useFloor, useSteady } from "./use_floor";
import { type Positions, useRobots } from "./use_robots";
import { useSight, useSize } from "./use_sight";
import { ViewButtons } from "./view_buttons";
import "./building.css";

interface PlanPanelProps {
  plan: Plan;
  run: string;
  moment: Moment;
  /** At the moment that is shown. */
  state: RunState;
}

export function PlanPanel({ plan, run, moment, state }: PlanPanelProps) {
  const source = useMemo(() => createPoseSource(run, helperName.peek(), moment), [run, moment]);
  useEffect(() => () => source.close(), [source]);
  const robots = useMemo(() => robotsAtWork(state, plan), [state, plan]);
  const marks = useRef<Marks>(null);
  const positions = useRef<Positions>(new Map());
  const draw = (now: Positions) => {
    positions.current = now;
    marks.current?.draw(now);
  };
  const paused = state.status === "paused";
  const seen = useRobots({ source, moment, plan, robots, speed: state.started.speed, paused }, draw);
  const [floor, setFloor] = useFloor(plan, seen);
  const view = useRef<HTMLDivElement>(null);
  const size = useSize(view);
  const controls = useSight(view, floor.box, size);
  const { sight } = controls;
  const names = useNames(floor, sight.scale);
  const [taken, setTaken] = useState<readonly Rect[]>([]);
  const hidden = useSteady(namesHidden(names, sight, size, taken));
  // What is moved by itself has to follow what is drawn anew.
  useEffect(() => marks.current?.draw(positions.current));
  const going = useRef<string | null>(null);
  const show = (robot: string) => {
    const there = plan.floors.find(({ name }) => name === seen.find((each) => each.robot === robot)?.floor);
    going.current = robot;
    if (there !== undefined) setFloor(there);
    // Its floor has to be there first.
    else going.current = null;
  };
  useEffect(() => {
    const at = going.current === null ? undefined : positions.current.get(going.current);
    going.current = null;
    if (at !== undefined) controls.show(at);
  });
  const several = plan.floors.length > 1;
  const title = several ? "Building" : `Building: ${floor.name}`;
  return (
    <section class="panel plan" aria-labelledby="plan-title">
      <div class="plan-bar">
        <h2 id="plan-title">{title}</h2>
        {several && <FloorTabs plan={plan} shown={floor} seen={seen} onChoose={setFloor} />}
        <ViewButtons controls={controls} />
      </div>
      <div id={FLOOR_PANEL} class="plan-panel" {...(several && { role: "tabpanel", "aria-labelledby": floorTab(plan, floor) })}>
        <div
          ref={view}
          class="plan-view"
          role="group"
          tabIndex={0}
          aria-label={`Floor ${floor.name}: arrow keys move it, plus and minus zoom, 0 shows all of it`}
          {...controls.handlers}
        >
          <FloorDrawing floor={floor} sight={sight} label={`Plan of ${floor.name}`}>
            <PlaceNames names={names} sight={sight} hidden={hidden} />
          </FloorDrawing>
          <RobotMarks {...{ plan, floor, sight, size, robots, seen, marks }} onTaken={setTaken} />
        </div>
      </div>
      <FloorLegend floor={floor} />
      <p class="plan-state small quiet">{stateSentence(source, moment, seen)}</p>
      <RobotList seen={seen} onShow={show} />
    </section>
  );
}

function stateSentence(source: PoseSource, moment: Moment, seen: readonly SeenRobot[]): string {
  const known = seen.some(({ where }) => where !== null);
  if (!moment.live.value) return known ? "" : "Nothing was recorded of this moment.";
  switch (source.state.value) {
    case "lost":
      return "The connection is lost: this is the last that is known.";
    case "refused":
      return "The service does not show where this run’s robots are.";
    default:
      return known ? "" : "Waiting for the robots to say where they are …";
  }
}

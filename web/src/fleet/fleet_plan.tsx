// The building of a fleet, one floor at a time: its robots, and the ways that are closed now.
import { useMemo, useRef, useState } from "preact/hooks";
import type { AtWork } from "../building/at_work";
import { FLOOR_PANEL, FloorTabs, floorTab } from "../building/floor_tabs";
import { FloorDrawing, FloorLegend } from "../building/floor_drawing";
import type { Rect } from "../building/labels";
import { namesHidden, PlaceNames, useNames } from "../building/place_names";
import type { Plan, PlanFloor } from "../building/plan";
import { type Marks, RobotMarks } from "../building/robot_marks";
import type { SeenRobot } from "../building/seen_robots";
import { useSteady } from "../building/use_floor";
import type { Positions } from "../building/use_robots";
import { useSight, useSize } from "../building/use_sight";
import { ViewButtons } from "../building/view_buttons";
import type { ClosedWayView } from "../wire/types";
import { PlanHits } from "./plan_hits";
import type { Picked } from "./picked";
import { useGliding } from "./use_gliding";
import "../building/building.css";

interface FleetPlanProps {
  plan: Plan;
  robots: readonly AtWork[];
  seen: readonly SeenRobot[];
  positions: Positions;
  closed: readonly ClosedWayView[];
  picked: Picked;
  onPick(picked: Picked): void;
  /** What is to be said of what is shown. */
  state: string;
  /** The floor that somebody has gone to, and how they go to another one. */
  floor: PlanFloor;
  onFloor(floor: PlanFloor): void;
}

export function FleetPlan(props: FleetPlanProps) {
  const { plan, robots, seen, positions, closed, picked, onPick, state, floor, onFloor } = props;
  const marks = useRef<Marks>(null);
  useGliding(positions, (now) => marks.current?.draw(now));
  const view = useRef<HTMLDivElement>(null);
  const size = useSize(view);
  const controls = useSight(view, floor.box, size);
  const { sight } = controls;
  const names = useNames(floor, sight.scale);
  const [taken, setTaken] = useState<readonly Rect[]>([]);
  const hidden = useSteady(namesHidden(names, sight, size, taken));
  const here = useMemo(() => robots.filter(({ robot }) => positions.has(robot)), [robots, positions]);
  return (
    <section class="panel plan" aria-labelledby="fleet-plan-title">
      <div class="plan-bar">
        <h2 id="fleet-plan-title">Building</h2>
        <FloorTabs plan={plan} shown={floor} seen={seen} onChoose={onFloor} />
        <ViewButtons controls={controls} />
      </div>
      <div id={FLOOR_PANEL} class="plan-panel" role="tabpanel" aria-labelledby={floorTab(plan, floor)}>
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
          <PlanHits {...{ floor, sight, closed, picked, onPick }} />
          <RobotMarks {...{ plan, floor, sight, size, seen, marks }} robots={here} onTaken={setTaken} />
        </div>
      </div>
      <FloorLegend floor={floor} />
      <p class="plan-state small quiet" role="status">
        {state}
      </p>
    </section>
  );
}


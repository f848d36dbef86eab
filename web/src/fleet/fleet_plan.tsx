// The building of a fleet, one floor at a time: its robots, and the ways that are closed now.
import { useMemo, useRef } from "preact/hooks";
import type { AtWork } from "../building/at_work";
import { FloorView, useFloorView } from "../building/floor_view";
import type { Plan, PlanFloor } from "../building/plan";
import { type Marks, RobotMarks } from "../building/robot_marks";
import type { SeenRobot } from "../building/seen_robots";
import type { Positions } from "../building/use_robots";
import type { ClosedWayView } from "../wire/types";
import { PlanHits } from "./plan_hits";
import type { Picked } from "./picked";
import { useGliding } from "./use_gliding";
import { t } from "../words/words";

interface FleetPlanProps {
  plan: Plan;
  robots: readonly AtWork[];
  seen: readonly SeenRobot[];
  positions: Positions;
  /** Whether they are as they are read now. */
  live: boolean;
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
  const { plan, robots, seen, positions, live, closed, picked, onPick, state, floor, onFloor } = props;
  const marks = useRef<Marks>(null);
  useGliding(positions, live, (now) => marks.current?.draw(now));
  const view = useFloorView(floor);
  const { sight, size } = view;
  const here = useMemo(() => robots.filter(({ robot }) => positions.has(robot)), [robots, positions]);
  return (
    <section class="panel plan" aria-labelledby="fleet-plan-title">
      <FloorView {...{ plan, floor, seen, view, onFloor }} heading={<h2 id="fleet-plan-title">{t("Building")}</h2>}>
        <PlanHits {...{ floor, sight, closed, picked, onPick }} />
        <RobotMarks {...{ plan, floor, sight, size, seen, marks }} robots={here} onTaken={view.setTaken} />
      </FloorView>
      <p class="plan-state small quiet" role="status">
        {state}
      </p>
    </section>
  );
}


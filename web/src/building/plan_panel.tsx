// The building of a run: one floor at a time, the robots on it at the moment that is shown.
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { RunState } from "../run/fold";
import type { Moment } from "../run/moment";
import { createPoseSource, type PoseSource } from "../run/scene/pose_source";
import { helperName } from "../state/preferences";
import { robotsAtWork } from "./at_work";
import { FloorView, useFloorView } from "./floor_view";
import type { Plan } from "./plan";
import { RobotList } from "./robot_list";
import { type Marks, RobotMarks } from "./robot_marks";
import type { SeenRobot } from "./seen_robots";
import { useFloor } from "./use_floor";
import { type Positions, useRobots } from "./use_robots";
import { t } from "../words/words";

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
  const view = useFloorView(floor);
  const { controls, sight, size } = view;
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
  const title = plan.floors.length > 1 ? t("Building") : t("Building: {name}", { name: floor.name });
  return (
    <section class="panel plan" aria-labelledby="plan-title">
      <FloorView {...{ plan, floor, seen, view }} onFloor={setFloor} heading={<h2 id="plan-title">{title}</h2>}>
        <RobotMarks {...{ plan, floor, sight, size, robots, seen, marks }} onTaken={view.setTaken} />
      </FloorView>
      <p class="plan-state small quiet">{stateSentence(source, moment, seen)}</p>
      <RobotList seen={seen} onShow={show} />
    </section>
  );
}

function stateSentence(source: PoseSource, moment: Moment, seen: readonly SeenRobot[]): string {
  const known = seen.some(({ where }) => where !== null);
  if (!moment.live.value) return known ? "" : t("Nothing was recorded of this moment.");
  switch (source.state.value) {
    case "lost":
      return t("The connection is lost: this is the last that is known.");
    case "refused":
      return t("The service does not show where this run’s robots are.");
    default:
      return known ? "" : t("Waiting for the robots to say where they are …");
  }
}

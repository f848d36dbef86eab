// The floors of a building, one of which is shown; each says how many robots are on it.
import { useRef } from "preact/hooks";
import "../run/tabs.css";
import type { Plan, PlanFloor } from "./plan";
import type { SeenRobot } from "./seen_robots";
import { t, tn } from "../words/words";

interface FloorTabsProps {
  plan: Plan;
  shown: PlanFloor;
  seen: readonly SeenRobot[];
  onChoose(floor: PlanFloor): void;
}

export const FLOOR_PANEL = "plan-floor-panel";
export const floorTab = (plan: Plan, floor: PlanFloor) => `plan-floor-${plan.floors.indexOf(floor)}`;

export function FloorTabs({ plan, shown, seen, onChoose }: FloorTabsProps) {
  const bar = useRef<HTMLDivElement>(null);
  const { floors } = plan;
  const onKeyDown = (event: KeyboardEvent) => {
    const at = floors.indexOf(shown);
    const last = floors.length - 1;
    const next = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: last }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    const floor = floors[next > last ? 0 : next < 0 ? last : next] as PlanFloor;
    onChoose(floor);
    bar.current?.querySelector<HTMLElement>(`#${floorTab(plan, floor)}`)?.focus();
  };
  return (
    <div class="tabs plan-tabs" role="tablist" aria-label={t("Floors")} ref={bar} onKeyDown={onKeyDown}>
      {floors.map((floor) => (
        <button
          key={floor.name}
          id={floorTab(plan, floor)}
          type="button"
          class="bare"
          role="tab"
          aria-selected={floor === shown}
          aria-controls={FLOOR_PANEL}
          tabIndex={floor === shown ? 0 : -1}
          onClick={() => onChoose(floor)}
        >
          {floor.name}
          <Robots there={seen.filter((robot) => robot.floor === floor.name)} />
        </button>
      ))}
    </div>
  );
}

function Robots({ there }: { there: readonly SeenRobot[] }) {
  if (there.length === 0) return null;
  const asks = there.filter(({ activity, unseen }) => activity === "asking" && unseen === null).length;
  return (
    <>
      <span class="plan-count">
        {there.length}
        <span class="unseen"> {there.length === 1 ? t("robot") : t("robots")}</span>
      </span>
      {asks > 0 && (
        <span class="plan-count asking">
          <span aria-hidden="true">? {asks}</span>
          <span class="unseen">{tn("one asks", "{count} ask", { count: asks })}</span>
        </span>
      )}
    </>
  );
}

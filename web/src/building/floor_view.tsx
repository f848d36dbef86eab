// One floor at a time: tabs, buttons, and the drawing that is moved and zoomed, with what is laid over it.
import type { ComponentChildren } from "preact";
import { useRef, useState } from "preact/hooks";
import { FloorDrawing, FloorLegend } from "./floor_drawing";
import { FLOOR_PANEL, FloorTabs, floorTab } from "./floor_tabs";
import type { Rect } from "./labels";
import { namesHidden, PlaceNames, useNames } from "./place_names";
import type { Plan, PlanFloor } from "./plan";
import type { SeenRobot } from "./seen_robots";
import { useSteady } from "./use_floor";
import { useSight, useSize } from "./use_sight";
import { ViewButtons } from "./view_buttons";
import { t } from "../words/words";
import "./building.css";

export function useFloorView(floor: PlanFloor) {
  const element = useRef<HTMLDivElement>(null);
  const size = useSize(element);
  const controls = useSight(element, floor.box, size);
  const names = useNames(floor, controls.sight.scale);
  const [taken, setTaken] = useState<readonly Rect[]>([]);
  const hidden = useSteady(namesHidden(names, controls.sight, size, taken));
  return { element, size, controls, sight: controls.sight, names, hidden, setTaken };
}

interface FloorViewProps {
  plan: Plan;
  floor: PlanFloor;
  view: ReturnType<typeof useFloorView>;
  /** Whose floors are marked on the tabs. */
  seen?: readonly SeenRobot[];
  heading?: ComponentChildren;
  onFloor(floor: PlanFloor): void;
  children?: ComponentChildren;
}

export function FloorView({ plan, floor, view, seen = [], heading, onFloor, children }: FloorViewProps) {
  const { element, controls, sight, names, hidden } = view;
  const several = plan.floors.length > 1;
  return (
    <>
      <div class="plan-bar">
        {heading}
        {several && <FloorTabs plan={plan} shown={floor} seen={seen} onChoose={onFloor} />}
        <ViewButtons controls={controls} />
      </div>
      <div id={FLOOR_PANEL} class="plan-panel" {...(several && { role: "tabpanel", "aria-labelledby": floorTab(plan, floor) })}>
        <div
          ref={element}
          class="plan-view"
          role="group"
          tabIndex={0}
          aria-label={t("Floor {name}: arrow keys move it, plus and minus zoom, 0 shows all of it", { name: floor.name })}
          {...controls.handlers}
        >
          <FloorDrawing floor={floor} sight={sight} label={t("Plan of {name}", { name: floor.name })}>
            <PlaceNames names={names} sight={sight} hidden={hidden} />
          </FloorDrawing>
          {children}
        </div>
      </div>
      <FloorLegend floor={floor} />
    </>
  );
}

// The building of a site, for who chooses where a run is to be. Where robots are that no run has nobody is told.
import { useEffect, useRef, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { FloorDrawing, FloorLegend } from "./floor_drawing";
import { FLOOR_PANEL, FloorTabs, floorTab } from "./floor_tabs";
import { namesHidden, PlaceNames, useNames } from "./place_names";
import { type Plan, planOf } from "./plan";
import { useSight, useSize } from "./use_sight";
import { ViewButtons } from "./view_buttons";
import "./building.css";

export function SitePlan({ scene }: { scene: string }) {
  const [plan, setPlan] = useState<Plan | null>(null);
  useEffect(() => {
    let wanted = true;
    setPlan(null);
    rest.scene(scene).then(
      ({ definition }) => wanted && setPlan(planOf(definition)),
      // The scene is another one by now, or gone: a run can be started all the same.
      () => undefined,
    );
    return () => {
      wanted = false;
    };
  }, [scene]);
  return plan === null ? null : <Floors key={scene} plan={plan} />;
}

function Floors({ plan }: { plan: Plan }) {
  const [chosen, setChosen] = useState(plan.floors[0]);
  const floor = chosen ?? plan.floors[0]!;
  const view = useRef<HTMLDivElement>(null);
  const size = useSize(view);
  const controls = useSight(view, floor.box, size);
  const { sight } = controls;
  const names = useNames(floor, sight.scale);
  return (
    <section class="plan" aria-label={`Building ${plan.name}`}>
      <div class="plan-bar">
        <FloorTabs plan={plan} shown={floor} seen={[]} onChoose={setChosen} />
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
            <PlaceNames names={names} sight={sight} hidden={namesHidden(names, sight, size, [])} />
          </FloorDrawing>
        </div>
      </div>
      <FloorLegend floor={floor} />
    </section>
  );
}

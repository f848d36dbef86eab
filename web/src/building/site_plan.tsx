// The building of a site, for who chooses where a run is to be. Where robots are that no run has nobody is told.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { FloorView, useFloorView } from "./floor_view";
import { type Plan, planOf } from "./plan";
import { t } from "../words/words";

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
  const view = useFloorView(floor);
  return (
    <section class="plan" aria-label={t("Building {name}", { name: plan.name })}>
      <FloorView plan={plan} floor={floor} view={view} onFloor={setChosen} />
    </section>
  );
}

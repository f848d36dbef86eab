// Which floor of a building is shown, and what of it has to be drawn anew.
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import type { Plan, PlanFloor } from "./plan";
import type { SeenRobot } from "./seen_robots";

/** The floor that is shown: what somebody has chosen, else that of who asks, else of the first robot that is known. */
export function useFloor(plan: Plan, seen: readonly SeenRobot[]): [PlanFloor, (floor: PlanFloor) => void] {
  const [chosen, setChosen] = useState<PlanFloor | null>(null);
  const known = seen.find(({ activity, floor }) => activity === "asking" && floor !== null) ?? seen.find(({ floor }) => floor !== null);
  const first = plan.floors.find(({ name }) => name === known?.floor) ?? null;
  useEffect(() => {
    // Whoever looks at a floor is not to be taken to another one.
    if (chosen === null && first !== null) setChosen(first);
  }, [first]);
  const shown = chosen ?? first ?? (plan.floors[0] as PlanFloor);
  return [shown, useCallback((floor) => setChosen(floor), [])];
}

/** The same set as long as it has the same in it. */
export function useSteady(set: ReadonlySet<string>): ReadonlySet<string> {
  const before = useRef(set);
  const same = set.size === before.current.size && [...set].every((each) => before.current.has(each));
  if (!same) before.current = set;
  return before.current;
}

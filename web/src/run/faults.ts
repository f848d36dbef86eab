// Where in a run something went wrong, for those who go from one fault to the next.
import type { Told } from "../wire/told";

type Fault = Extract<Told, { type: "issue_raised" | "node_undone" | "robot_lost" }>;

function isFault(event: Told): event is Fault {
  return event.type === "issue_raised" || event.type === "node_undone" || event.type === "robot_lost";
}

/** The fault before or after what is shown of a run, whose last event is `seq`; null where there is none. */
export function faultBeside(events: readonly Told[], seq: number, direction: -1 | 1): Fault | null {
  if (direction === 1) return events.find((event): event is Fault => isFault(event) && event.seq > seq) ?? null;
  return events.findLast((event): event is Fault => isFault(event) && event.seq < seq) ?? null;
}

// Whether whoever asks at a robot's touch screen can be helped by it, by another one, or by none.
import type { FleetView } from "../wire/types";

/** "out": it is out of service and another robot works; "alone": out of service, and none works. */
export type Service = "in" | "out" | "alone";

export function serviceOf(robot: string, { robots }: Pick<FleetView, "robots">): Service {
  const own = robots.find((each) => each.robot === robot);
  if (own === undefined || own.out_of_service === null) return "in";
  const another = robots.some((each) => each.robot !== robot && each.works && each.out_of_service === null);
  return another ? "out" : "alone";
}

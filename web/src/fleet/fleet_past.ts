// What is known of a fleet at a moment of its past, folded from its events.
import type { Event, FleetLeg, LegAction, RequestStatus, RequestView } from "../wire/types";

export type FleetEvent = Extract<Event, { at_s: number }>;

export function isOfFleet(event: Event): event is FleetEvent {
  return "at_s" in event;
}

/** The events until a moment of the site's clock. */
export function eventsUntil(events: readonly FleetEvent[], time: number): readonly FleetEvent[] {
  return events.filter(({ at_s }) => at_s <= time);
}

/**
 * The requests as they were told of last, in the order in which they came. When they were expected is not kept: that
 * changes with the plan and with the time.
 */
export function requestsAfter(events: readonly FleetEvent[]): readonly RequestView[] {
  const requests = new Map<string, RequestView>();
  for (const event of events) {
    if (event.type !== "request_changed") continue;
    const { request: name, site, what, reason } = event;
    requests.set(name, { name, site, what, status: event.status as RequestStatus, reason, expected: null, waits: null });
  }
  return [...requests.values()];
}

/** What each robot was at, after the last of these events; robots that were at nothing are not there. */
export function legsAfter(events: readonly FleetEvent[]): ReadonlyMap<string, FleetLeg> {
  const legs = new Map<string, FleetLeg>();
  for (const event of events) {
    switch (event.type) {
      case "leg_begun":
        legs.set(event.robot, { place: event.place, action: event.action as LegAction, request: event.booking, charges: false });
        break;
      case "errand_begun":
        legs.set(event.robot, { place: event.place, action: null, request: null, charges: event.charges });
        break;
      case "leg_ended":
      case "errand_ended":
        legs.delete(event.robot);
    }
  }
  return legs;
}

// What became of a fleet, read from the site's events and followed as they come.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { type FleetEvent, isOfFleet } from "./fleet_past";

const AGAIN_MS = 1_000;

/** In the order in which they happened; null until they were read. */
export function useSiteEvents(site: string): readonly FleetEvent[] | null {
  const [events, setEvents] = useState<readonly FleetEvent[] | null>(null);
  useEffect(() => {
    let current = true;
    let timer = 0;
    let last = 0;
    const read = async () => {
      // What could not be read comes with the next try.
      const some = await rest.siteEvents(site, last).catch(() => null);
      if (!current) return;
      if (some !== null) {
        last = some.at(-1)?.seq ?? last;
        const ofFleet = some.filter(isOfFleet);
        setEvents((before) => (before !== null && ofFleet.length === 0 ? before : [...(before ?? []), ...ofFleet]));
      }
      timer = window.setTimeout(() => void read(), AGAIN_MS);
    };
    void read();
    return () => {
      current = false;
      window.clearTimeout(timer);
    };
  }, [site]);
  return events;
}

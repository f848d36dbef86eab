// What the service's runs and robots come to, as this device knows it.
import { fleets } from "../requests/fleets";
import { knownFailures } from "../state/preferences";
import { robots } from "../state/robots";
import { connection, runs, runsRead, trouble } from "../state/service";
import { useNow } from "../state/use_now";
import { type Glance, glanceOf } from "./glance";

export function useGlance(): Glance {
  const now = useNow();
  return glanceOf({
    connection: connection.value,
    trouble: trouble.value,
    known: knownFailures.value,
    runs: runsRead.value ? [...runs.value.values()] : null,
    robots: robots.value,
    ofFleets: new Set(fleets.value?.flatMap((site) => site.robots.map(({ robot }) => robot))),
    now,
  });
}

/** Whether there is anything that somebody has to see after. */
export function tellsOf({ failures, lost }: Glance): boolean {
  return failures.length + lost.length > 0;
}

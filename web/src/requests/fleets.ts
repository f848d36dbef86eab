// The sites whose robots take requests.
import { signal } from "@preact/signals";
import { onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { SiteView } from "../wire/types";

const AGAIN_MS = 15_000;

/** Null until they were read. */
export const fleets = signal<readonly SiteView[] | null>(null);

/** The site of a fleet; without its id that which comes first. */
export function fleetAt(site: string | null): SiteView | null {
  return fleets.value?.find(({ id }) => site === null || id === site) ?? null;
}

export async function readFleets(): Promise<void> {
  const sites = await rest.sites();
  fleets.value = sites.filter(({ fleet }) => fleet !== null);
}

const read = () => void readFleets().catch(() => undefined);

/** Sites come and go: look again and again, and whenever the service is there again. */
export function followFleets(): () => void {
  const stop = onSnapshot(read);
  const timer = setInterval(read, AGAIN_MS);
  read();
  return () => {
    stop();
    clearInterval(timer);
  };
}

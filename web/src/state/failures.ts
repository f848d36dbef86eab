// The runs that ended badly of which somebody knows on this device.
import { knownFailures } from "./preferences";

const MOST_KNOWN = 200;

/** Somebody here knows what became of a run. */
export function noteKnown(run: string): void {
  if (knownFailures.value.includes(run)) return;
  knownFailures.value = [...knownFailures.value, run].slice(-MOST_KNOWN);
}

// A device that stands beside a robot: its screen stays on, questions are spoken, and it listens from the start.
import { signal } from "@preact/signals";
import { may } from "../state/access";
import { speechPhase } from "../speech/speech_state";
import { switchOff, switchOn } from "../speech/speech_switch";
import { unlock } from "./sounds";
import { type Awake, keepAwake } from "./wake_lock";

export const awake = signal<Awake | null>(null);

/** Begin; returns how to stop. */
export function standBeside(): () => void {
  const release = keepAwake((now) => {
    awake.value = now;
  });
  // Says beforehand where the page cannot be heard, and not only when a robot asks.
  void unlock();
  if (may("helper") && speechPhase.peek() === "off") void switchOn().catch(() => undefined);
  return () => {
    release();
    awake.value = null;
    switchOff();
  };
}

// What this helper has set on this device.
import { effect, type Signal, signal } from "@preact/signals";

export type Theme = "system" | "light" | "dark";

/** Who says the questions: the service, or this browser where it has a voice of its own. */
export type Voice = "service" | "browser";

/** The single keys that do something while a question is open; empty switches one off. */
export interface Keys {
  yes: string;
  no: string;
  repeat: string;
}

export const DEFAULT_KEYS: Keys = { yes: "y", no: "n", repeat: "r" };

export function kept<T>(name: string, value: T): Signal<T> {
  const found = localStorage.getItem(`mend.${name}`);
  const held = signal(found === null ? value : (JSON.parse(found) as T));
  effect(() => localStorage.setItem(`mend.${name}`, JSON.stringify(held.value)));
  return held;
}

export const helperName = kept("helper", "");
export const theme = kept<Theme>("theme", "system");
export const keys = kept<Keys>("keys", DEFAULT_KEYS);
export const keysOn = kept("keys_on", true);
export const soundOn = kept("sound_on", true);
export const voice = kept<Voice>("voice", "service");
/** The runs that ended badly which were looked at, or put aside, on this device; the latest last. */
export const knownFailures = kept<readonly string[]>("known_failures", []);
/** Whether the service is to call this device also while no page is open. */
export const pushOn = kept("push_on", false);
/** Whether this device stands beside a robot: it stays awake, speaks and listens. */
export const besideRobot = kept("beside_robot", false);
export const notificationsOn = kept("notifications_on", false);

effect(() => {
  const chosen = theme.value;
  if (chosen === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = chosen;
});

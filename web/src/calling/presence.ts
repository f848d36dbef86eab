// Whether somebody is at this page, from what they do and how it is shown.
import { effect, signal } from "@preact/signals";
import { route } from "../app/router";
import { besideRobot } from "../state/preferences";
import { speechPhase } from "../speech/speech_state";
import { AtPage, type Presence } from "./at_page";

const SIGNS = ["pointerdown", "pointermove", "keydown", "wheel", "touchstart"];

let told: (presence: Presence) => void = () => undefined;

const page = new AtPage(
  {
    tell: (now) => {
      presence.value = now;
      told(now);
    },
    now: () => performance.now(),
    later: (ms, then) => {
      const timer = window.setTimeout(then, ms);
      return () => window.clearTimeout(timer);
    },
  },
  isShown(),
);

export const presence = signal<Presence>(page.presence);

/** Hear of it whenever the service is to. */
export function onPresence(listener: (presence: Presence) => void): void {
  told = listener;
}

/** After how many seconds without a sign the service counts this helper as away. */
export function awayAfter(seconds: number): void {
  page.awayAfter(seconds);
}

function isShown(): boolean {
  return document.visibilityState !== "hidden";
}

for (const sign of SIGNS) window.addEventListener(sign, () => page.acted(), { capture: true, passive: true });
document.addEventListener("visibilitychange", () => page.shows(isShown()));
effect(() => page.stands(route.value.view === "touch" ? "before_robot" : besideRobot.value ? "beside_robot" : null));
effect(() => {
  if (speechPhase.value === "hearing") page.acted();
});

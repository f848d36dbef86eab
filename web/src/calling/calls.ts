// Calls this helper: by sound until somebody is on it, by the title, and by the number on the page's icon.
import { computed, effect, signal, untracked } from "@preact/signals";
import { helperName, soundOn } from "../state/preferences";
import { type Question, questions, together } from "../state/questions";
import { lostRobots } from "../state/robots";
import { runs } from "../state/service";
import { isTurnOf } from "../question/turn";
import { Ringer, ringing, ringOfLost } from "./ringing";
import { playCall } from "./sounds";
import { t } from "../words/words";

const putOff = signal<ReadonlySet<string>>(new Set());

/** Robots that are gone, of which nobody at this device has said that they know; none of a run that a script answers. */
export const missed = computed(() =>
  lostRobots.value.filter((each) => runs.value.get(each.run ?? "")?.live !== false && !putOff.value.has(ringOfLost(each))),
);

/** What this helper is called about on this device, now. */
export const rings = computed(() => ringing(questions.value, together.value, helperName.value, putOff.value, missed.value));

/** Whether a question is one that this helper does not want to be called about here. */
export function isPutOff({ prompt }: Pick<Question, "prompt">): boolean {
  return prompt !== null && putOff.value.has(prompt.prompt);
}

/** Not me, not now: this device calls nobody about a question any more; the others are asked all the same. */
export function putOffCalls({ prompt }: Pick<Question, "prompt">): void {
  if (prompt !== null) putOff.value = new Set([...putOff.value, prompt.prompt]);
}

/** Whoever is at this device knows of the robots that are gone. */
export function knowOfMissed(): void {
  putOff.value = new Set([...putOff.value, ...missed.value.map(ringOfLost)]);
}

export function takeCallsAgain({ prompt }: Pick<Question, "prompt">): void {
  putOff.value = new Set([...putOff.value].filter((each) => each !== prompt?.prompt));
}

const ringer = new Ringer({
  ring: (urgent) => {
    if (soundOn.value) playCall(urgent);
  },
  later: (ms, then) => {
    const timer = window.setTimeout(then, ms);
    return () => window.clearTimeout(timer);
  },
});

effect(() => {
  const now = rings.value;
  untracked(() => ringer.set(now));
});

effect(() => {
  const count = questions.value.filter((each) => isTurnOf(helperName.value, each)).length + missed.value.length;
  const urgent = rings.value.some((each) => each.urgent);
  document.title = `${count > 0 ? `(${count}) ` : ""}${urgent ? t("Help now!") : ""}Mend`;
  if (count > 0) void navigator.setAppBadge?.(count).catch(() => undefined);
  else void navigator.clearAppBadge?.().catch(() => undefined);
});

// A question has come to this helper: screen readers are told, and the desktop while the page is in the background.
import { effect, signal, untracked } from "@preact/signals";
import { missed } from "../calling/calls";
import { ringOf, ringOfLost } from "../calling/ringing";
import { helperName, notificationsOn, pushOn } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { isTurnOf } from "./turn";

/** The question that came last; null when it is no longer open. */
export const newest = signal<Question | null>(null);

const known = new Set<string>();
/** The dialogues, and what rings of lost robots, that a notification of this page is about. */
const noticed = new Set<string>();

effect(() => {
  const open = questions.value.filter((each) => isTurnOf(helperName.value, each));
  const fresh = open.filter((each) => each.prompt !== null && !known.has(ringOf(each)));
  for (const each of fresh) known.add(ringOf(each));
  const over = [...noticed].filter((tag) => !tag.startsWith("lost ") && open.every((each) => each.dialogue !== tag));
  for (const dialogue of over) noticed.delete(dialogue);
  untracked(() => {
    if (over.length > 0) void import("../calling/page_notices").then(({ takeAway }) => takeAway(over));
    const last = fresh.at(-1);
    if (last !== undefined) arrive(last);
    else if (!open.some((each) => each.prompt?.prompt === newest.value?.prompt?.prompt)) newest.value = null;
  });
});

let gone: readonly string[] = [];

effect(() => {
  const lost = missed.value;
  const before = gone;
  gone = lost.map(ringOfLost);
  untracked(() => {
    const over = before.filter((each) => noticed.has(each) && !gone.includes(each));
    for (const each of over) noticed.delete(each);
    if (over.length > 0) void import("../calling/page_notices").then(({ takeAway }) => takeAway(over));
    for (const each of lost) {
      const ring = ringOfLost(each);
      if (before.includes(ring) || !mayNotify()) continue;
      noticed.add(ring);
      void import("../calling/page_notices").then(({ notifyOfLost }) => notifyOfLost(each));
    }
  });
});

function arrive(question: Question): void {
  newest.value = question;
  if (!mayNotify()) return;
  noticed.add(question.dialogue);
  void import("../calling/page_notices").then(({ notify }) => notify(question));
}

/** Whether the page is in the background, and nothing else shows the same: a device that is called by push does. */
function mayNotify(): boolean {
  if (document.visibilityState === "visible" && document.hasFocus()) return false;
  if (!notificationsOn.value || pushOn.value) return false;
  return "Notification" in window && Notification.permission === "granted";
}

// A question has come to this helper: screen readers are told, and the desktop while the page is in the background.
import { effect, signal, untracked } from "@preact/signals";
import { ringOf } from "../calling/ringing";
import { helperName, notificationsOn, pushOn } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { isTurnOf } from "./turn";

/** The question that came last; null when it is no longer open. */
export const newest = signal<Question | null>(null);

const known = new Set<string>();
/** The dialogues that a notification of this page is about. */
const noticed = new Set<string>();

effect(() => {
  const open = questions.value.filter((each) => isTurnOf(helperName.value, each));
  const fresh = open.filter((each) => each.prompt !== null && !known.has(ringOf(each)));
  for (const each of fresh) known.add(ringOf(each));
  const gone = [...noticed].filter((dialogue) => open.every((each) => each.dialogue !== dialogue));
  for (const dialogue of gone) noticed.delete(dialogue);
  untracked(() => {
    if (gone.length > 0) void import("../calling/page_notices").then(({ takeAway }) => takeAway(gone));
    const last = fresh.at(-1);
    if (last !== undefined) arrive(last);
    else if (!open.some((each) => each.prompt?.prompt === newest.value?.prompt?.prompt)) newest.value = null;
  });
});

function arrive(question: Question): void {
  newest.value = question;
  if (document.visibilityState === "visible" && document.hasFocus()) return;
  // A device that is called by push shows the same thing by that.
  if (!notificationsOn.value || pushOn.value) return;
  if (!("Notification" in window) || Notification.permission !== "granted") return;
  noticed.add(question.dialogue);
  void import("../calling/page_notices").then(({ notify }) => notify(question));
}

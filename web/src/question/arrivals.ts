// A question has come: the title counts it, and the page makes itself heard, as nobody may look.
import { effect, signal, untracked } from "@preact/signals";
import { notificationsOn, soundOn } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { playChime } from "./chime";
import { faultInWords, robotName } from "./fault_words";

/** The question that came last; null when it is no longer open. */
export const newest = signal<Question | null>(null);

const known = new Set<string>();

effect(() => {
  const open = questions.value;
  document.title = open.length > 0 ? `(${open.length}) Mend` : "Mend";
  const fresh = open.filter((each) => each.prompt !== null && !known.has(each.prompt.prompt));
  for (const each of fresh) known.add(each.prompt?.prompt ?? "");
  untracked(() => {
    const last = fresh.at(-1);
    if (last !== undefined) arrive(last);
    else if (!open.some((each) => each.prompt?.prompt === newest.value?.prompt?.prompt)) newest.value = null;
  });
});

function arrive(question: Question): void {
  newest.value = question;
  if (soundOn.value) playChime();
  if (document.visibilityState === "visible" && document.hasFocus()) return;
  if (!notificationsOn.value || !("Notification" in window) || Notification.permission !== "granted") return;
  notify(question);
}

function notify(question: Question): void {
  let note: Notification;
  try {
    note = new Notification(`${robotName(question.robot)} asks for help`, {
      body: `${faultInWords(question)} ${question.prompt?.text ?? ""}`,
      tag: question.dialogue,
      icon: "/icon.svg",
    });
  } catch {
    // Browsers of telephones have none from pages, though they say that they may.
    return;
  }
  note.onclick = () => {
    window.focus();
    note.close();
  };
}

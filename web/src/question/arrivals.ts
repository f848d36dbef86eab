// A question has come to this helper: the title counts it, and the page makes itself heard.
import { effect, signal, untracked } from "@preact/signals";
import { helperName, notificationsOn, soundOn } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { playChime } from "./chime";
import { faultInWords, robotName } from "./fault_words";
import { askedNow, isTurnOf } from "./turn";

/** The question that came last; null when it is no longer open. */
export const newest = signal<Question | null>(null);

const known = new Set<string>();

effect(() => {
  const open = questions.value.filter((each) => isTurnOf(helperName.value, each));
  document.title = open.length > 0 ? `(${open.length}) Mend` : "Mend";
  const fresh = open.filter((each) => each.prompt !== null && !known.has(call(each)));
  for (const each of fresh) known.add(call(each));
  untracked(() => {
    const last = fresh.at(-1);
    if (last !== undefined) arrive(last);
    else if (!open.some((each) => each.prompt?.prompt === newest.value?.prompt?.prompt)) newest.value = null;
  });
});

/** What is told once: a question, to anybody or to the helper whose turn has come. */
function call(question: Question): string {
  return `${question.prompt?.prompt} ${askedNow(question)}`;
}

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

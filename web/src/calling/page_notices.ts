// Notifications that the page itself shows while it is in the background.
import type { Question } from "../state/questions";
import { callNotice, lostNotice, type Notice } from "./notices";
import { ringOfLost } from "./ringing";
import { whyNoWorker, worker } from "./registration";
import type { RobotView } from "../wire/types";
import { said } from "../words/said";

export async function notify(question: Question): Promise<void> {
  const { dialogue, run, robot } = question;
  const text = said(question.prompt?.text ?? "");
  await show(callNotice({ dialogue, run, robot, text, sentences: [], urgent: !question.interrupts }, true));
}

/** By the tag of what it rings by. */
export async function notifyOfLost(lost: RobotView): Promise<void> {
  await show(lostNotice({ dialogue: ringOfLost(lost), robot: lost.robot }, true));
}

async function show({ title, options }: Notice): Promise<void> {
  try {
    // Browsers of telephones show those of a service worker alone.
    if (whyNoWorker() === null) await (await worker()).showNotification(title, options);
    else new Notification(title, options);
  } catch {
    // The helper has taken the permission back: the page itself says what is asked.
  }
}

/** Nobody is asked any more in these dialogues, or called about what rings so. */
export async function takeAway(dialogues: readonly string[]): Promise<void> {
  if (whyNoWorker() !== null) return;
  const shown = (await (await navigator.serviceWorker.getRegistration())?.getNotifications()) ?? [];
  for (const each of shown) if (dialogues.includes(each.tag)) each.close();
}

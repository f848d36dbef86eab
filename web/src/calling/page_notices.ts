// Notifications that the page itself shows while it is in the background.
import { type Question } from "../state/questions";
import { callNotice } from "./notices";
import { whyNoWorker, worker } from "./registration";

export async function notify(question: Question): Promise<void> {
  const { dialogue, run, robot } = question;
  const text = question.prompt?.text ?? "";
  const { title, options } = callNotice({ dialogue, run, robot, text, urgent: !question.interrupts }, true);
  try {
    // Browsers of telephones show those of a service worker alone.
    if (whyNoWorker() === null) await (await worker()).showNotification(title, options);
    else new Notification(title, options);
  } catch {
    // The helper has taken the permission back: the page itself says what is asked.
  }
}

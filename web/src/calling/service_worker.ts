// Runs without a page: shows what is pushed to this device, and takes it away when it is over.
// It answers no request and keeps no file, so that the console is never older than the service.
import type { PushMessage, WithdrawnMessage } from "../wire/types";
import { callNotice, lostNotice, type Notice, OVER, overNotice, trialNotice } from "./notices";
import { addWords, type Words } from "../words/words";
import { takeSentences } from "../words/said";

interface Waiting extends Event {
  waitUntil(work: Promise<unknown>): void;
}
interface Pushed extends Waiting {
  data: { json(): unknown } | null;
}
interface Clicked extends Waiting {
  notification: Notification;
}
interface Page {
  focused: boolean;
  visibilityState: string;
  focus(): Promise<Page>;
  postMessage(message: unknown): void;
}
declare const self: EventTarget & {
  location: Location;
  registration: ServiceWorkerRegistration;
  skipWaiting(): Promise<void>;
  clients: {
    claim(): Promise<void>;
    matchAll(options: { type: "window"; includeUncontrolled: boolean }): Promise<Page[]>;
    openWindow(address: string): Promise<unknown>;
  };
};

// All languages are here: a worker loads nothing later.
const TEXTS = import.meta.glob<Words>("../../texts/*/{notices,sentences,clauses}.json", { eager: true, import: "default" });
const language = new URLSearchParams(self.location.search).get("language") ?? "en";
const textsIn = (file: string) => TEXTS[`../../texts/${language}/${file}.json`] ?? {};
addWords(textsIn("notices"));
takeSentences(textsIn("sentences"), textsIn("clauses"));

const pages = () => self.clients.matchAll({ type: "window", includeUncontrolled: true });
const show = ({ title, options }: Notice) => self.registration.showNotification(title, options);

async function take(message: PushMessage): Promise<void> {
  const open = await pages();
  const watched = open.some((page) => page.focused && page.visibilityState === "visible");
  if (message.type === "call") await show(callNotice(message, watched));
  else if (message.type === "robot_lost") await show(lostNotice(message, watched));
  else if (message.type === "withdrawn") await takeAway(message, watched);
  else {
    await show(trialNotice());
    for (const page of open) page.postMessage({ type: "trial", nonce: message.nonce });
  }
}

/** Close what was shown. Browsers end a subscription whose pushes show nothing: where nothing else is, this is said. */
async function takeAway(message: WithdrawnMessage, watched: boolean): Promise<void> {
  const shown = await self.registration.getNotifications();
  const over = shown.filter((each) => each.tag === message.dialogue);
  for (const each of over) each.close();
  if (!watched && shown.length === over.length) await show(overNotice(message));
}

async function open(dialogue: string | undefined): Promise<void> {
  const [page] = await pages();
  if (page === undefined) await self.clients.openWindow("/");
  else (await page.focus()).postMessage({ type: "open", dialogue });
}

self.addEventListener("install", () => void self.skipWaiting());
self.addEventListener("activate", (event) => (event as Waiting).waitUntil(self.clients.claim()));
self.addEventListener("push", (event) => {
  const { data } = event as Pushed;
  if (data !== null) (event as Pushed).waitUntil(take(data.json() as PushMessage));
});
self.addEventListener("notificationclick", (event) => {
  const { notification } = event as Clicked;
  notification.close();
  if (notification.tag !== OVER) (event as Clicked).waitUntil(open((notification.data as { dialogue?: string } | null)?.dialogue));
});

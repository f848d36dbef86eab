// Web push to this device: asked for here, kept by the service, and asked for again whenever it has got lost.
import { helperName, pushOn } from "../state/preferences";
import * as rest from "../wire/rest";
import type { DeviceView } from "../wire/types";
import { deviceName } from "./device_name";
import { whyNoWorker, worker } from "./registration";
import { t } from "../words/words";

/** Why this device cannot be called while the page is closed, as a sentence; null where it can. */
export function whyNoPush(): string | null {
  const why = whyNoWorker();
  if (why !== null) return why;
  if (!("PushManager" in window) || !("Notification" in window)) {
    const apple = /iPhone|iPad/.test(navigator.userAgent);
    return apple ? t("On an iPhone or iPad, first put this page on the home screen, and open it from there.") : t("This browser has no push.");
  }
  return null;
}

/** Have the service call this device; rejects with why it cannot be. */
export async function callThisDevice(): Promise<DeviceView> {
  const why = whyNoPush();
  if (why !== null) throw new Error(why);
  if ((await Notification.requestPermission()) !== "granted") {
    throw new Error(t("This browser does not let this page notify you. Its site settings can change that."));
  }
  const { available, key } = await rest.push(helperName.value);
  if (!available) throw new Error(t("This service pushes to nobody: its operators have switched that off."));
  const device = await rest.addPushSubscription(await subscription(key), deviceName(navigator.userAgent), helperName.value);
  pushOn.value = true;
  return device;
}

async function subscription(key: string): Promise<PushSubscription> {
  const { pushManager } = await worker();
  const found = await pushManager.getSubscription();
  if (found !== null && keyOf(found) === key) return found;
  await found?.unsubscribe();
  return pushManager.subscribe({ userVisibleOnly: true, applicationServerKey: key }).catch((error: Error) => {
    throw new Error(t("This browser's push service does not take this device ({message}).", { message: error.message }));
  });
}

/** Have it call this device no more. */
export async function callThisDeviceNoMore(): Promise<void> {
  pushOn.value = false;
  const found = await currentSubscription();
  if (found === null) return;
  const id = await deviceId(found.endpoint);
  await found.unsubscribe();
  await rest.endPushSubscription(id).catch(() => undefined);
}

/** The subscription that this browser has; null for none. */
export async function currentSubscription(): Promise<PushSubscription | null> {
  if (whyNoPush() !== null) return null;
  const registration = await navigator.serviceWorker.getRegistration();
  return (await registration?.pushManager.getSubscription()) ?? null;
}

/** As the service calls what a browser subscribed. */
export async function deviceId(endpoint: string): Promise<string> {
  const digest = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(endpoint));
  return [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("").slice(0, 32);
}

/** What was subscribed before may have ended at either end since: ask for it again. */
export async function callThisDeviceStill(): Promise<void> {
  if (!pushOn.value || whyNoPush() !== null || Notification.permission !== "granted") return;
  await callThisDevice().catch(() => undefined);
}

function keyOf(found: PushSubscription): string {
  const bytes = new Uint8Array(found.options.applicationServerKey ?? new ArrayBuffer(0));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

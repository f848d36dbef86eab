// The service worker of this browser, and what it tells the pages.
import { go } from "../app/router";
import { choose } from "../question/queue";
import { t } from "../words/words";
import { language } from "../words/language";

const WORKER = "/service_worker.js";

/** Why this browser can run no service worker here, as a sentence; null where it can. */
export function whyNoWorker(): string | null {
  if (!window.isSecureContext) return t("This page did not come over https, so that browsers let it do less.");
  return "serviceWorker" in navigator ? null : t("This browser cannot show anything while the page is closed.");
}

/** The worker, once it runs; it is the newest there is. */
export async function worker(): Promise<ServiceWorkerRegistration> {
  await navigator.serviceWorker.register(language === "en" ? WORKER : `${WORKER}?language=${language}`, { updateViaCache: "none" });
  return navigator.serviceWorker.ready;
}

const trials = new Map<string, () => void>();

/** Resolves when the push with this nonce has come to this device. */
export function trialArrives(nonce: string): Promise<void> {
  return new Promise((resolve) => trials.set(nonce, resolve));
}

if ("serviceWorker" in navigator) {
  navigator.serviceWorker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
    if (data.type === "trial") trials.get(data.nonce)?.();
    else {
      go("/");
      if (data.dialogue !== undefined) choose(data.dialogue);
    }
  });
}

type FromWorker = { type: "trial"; nonce: string } | { type: "open"; dialogue?: string };

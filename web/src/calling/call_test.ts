// Whether this device will really call its helper: each thing is done, not only looked up.
import { may } from "../state/access";
import { besideRobot, helperName, pushOn, soundOn } from "../state/preferences";
import { speechLacks, speechPhase } from "../speech/speech_state";
import * as rest from "../wire/rest";
import type { Finding } from "./findings";
import { currentSubscription, deviceId, whyNoPush } from "./push";
import { trialArrives } from "./registration";
import { play } from "./sounds";
import { tryToKeepAwake } from "./wake_lock";
import { decimal, t } from "../words/words";
import { said, whyNotDone } from "../words/said";

type Found = Omit<Finding, "what">;
type Check = readonly [what: string, find: () => Promise<Found>];

const well = (words: string): Found => ({ state: "well", words });
const bad = (words: string): Found => ({ state: "bad", words });
const unused = (words: string): Found => ({ state: "unused", words });

const ARRIVES_WITHIN_MS = 15_000;

export const CHECKS: readonly Check[] = [
  [t("Your turn"), turn],
  [t("Sound"), sound],
  [t("Permission to notify"), permission],
  [t("Called while the page is closed"), subscribed],
  [t("A push all the way"), roundTrip],
  [t("Vibration"), vibration],
  [t("Screen stays on"), screen],
  [t("Listens and speaks"), speech],
];

/** Do all of it, in order; `tell` hears of each as it is found. */
export async function testCalling(tell: (finding: Finding) => void): Promise<Finding[]> {
  const findings: Finding[] = [];
  for (const [what, find] of CHECKS) {
    const found = await find().catch((error: Error) => bad(whyNotDone(error)));
    findings.push({ what, ...found });
    tell({ what, ...found });
  }
  return findings;
}

async function turn(): Promise<Found> {
  if (!may("helper")) return bad(t("Answering needs the role helper: ask an admin for it."));
  const { asked } = await rest.push(helperName.value);
  const me = helperName.value;
  return asked ? well(t("Robots ask “{me}”.", { me })) : bad(t("Robots ask others, and never “{me}”: an operator can add you to the setting “helpers”.", { me }));
}

async function sound(): Promise<Found> {
  if (!soundOn.value) return bad(t("It is switched off above."));
  if (await play(false)) return well(t("Played to its end. Did you not hear it? Then turn the volume of this device up."));
  return bad(t("The browser did not let it be heard. Allow this page to play sound in the browser's site settings."));
}

async function permission(): Promise<Found> {
  if (!("Notification" in window)) return bad(whyNoPush() ?? t("This browser has no notifications."));
  switch (Notification.permission) {
    case "granted":
      return well(t("Given."));
    case "denied":
      return bad(t("Refused in this browser: allow notifications of this page in its site settings."));
    default:
      return unused(t("Not asked for yet: that comes with switching calls to this device on above."));
  }
}

async function subscribed(): Promise<Found> {
  const why = whyNoPush();
  if (why !== null) return bad(why);
  if (!pushOn.value) return unused(t("Switched off above."));
  const found = await currentSubscription();
  const id = found === null ? null : await deviceId(found.endpoint);
  const devices = await rest.pushSubscriptions();
  if (devices.some((each) => each.id === id)) return well(t("The service knows this device."));
  return bad(t("The service does not know this device (any more): switch calls to this device off and on again above."));
}

async function roundTrip(): Promise<Found> {
  const found = await currentSubscription();
  if (found === null || !pushOn.value) return unused(t("Not tried, as this device is not called while the page is closed."));
  const nonce = crypto.randomUUID();
  const arrives = trialArrives(nonce);
  const begun = performance.now();
  const { outcome, why } = await rest.tryPushSubscription(await deviceId(found.endpoint), nonce);
  if (outcome !== "taken") return bad(t("It was not sent: {why}.", { why: said(why) }));
  const late = new Promise<"late">((resolve) => window.setTimeout(() => resolve("late"), ARRIVES_WITHIN_MS));
  if ((await Promise.race([arrives, late])) === "late") {
    return bad(t("Sent, but not here within 15 s. Is this device connected to the internet, and not saving power?"));
  }
  return well(t("Came back after {seconds} s. Did you see a notification? If not, look at the device's “do not disturb”.", { seconds: decimal((performance.now() - begun) / 1000, 1) }));
}

async function vibration(): Promise<Found> {
  if (navigator.vibrate === undefined) return unused(t("This device or browser has none."));
  const asked = navigator.vibrate([200, 120, 200]);
  return unused(asked ? t("Asked for; whether this device has done it can only be felt.") : t("The browser does not let this page use it."));
}

async function screen(): Promise<Found> {
  const awake = await tryToKeepAwake();
  if (awake === "held") return well(t("The screen can be kept on."));
  const words =
    awake === "absent"
      ? t("This browser cannot keep the screen on: set the device itself never to lock, and use https.")
      : t("The device does not keep its screen on now: is its battery low, or is it saving power?");
  return besideRobot.value ? bad(words) : unused(words);
}

async function speech(): Promise<Found> {
  if (!besideRobot.value) return unused(t("Only devices that stand beside a robot do."));
  if (speechPhase.value === "off") return bad(t("It is off: touch “Listen and speak” at a question, or load this page again."));
  return speechLacks.value === "" ? well(t("It is on.")) : bad(speechLacks.value);
}

// How the spoken side stands, for the card to show; the code that speaks is loaded when it is used.
import { signal } from "@preact/signals";

export type SpeechPhase =
  | "off"
  | "starting"
  /** Between two questions. */
  | "idle"
  | "speaking"
  | "listening"
  | "hearing"
  /** It did not work out by voice: the buttons are there. */
  | "gave_up";

export const speechPhase = signal<SpeechPhase>("off");

/** How to say yes and no to the service, where it listens to another language than the page's; null where it does not. */
export const listensTo = signal<{ language: string; yes: string; no: string; done: string; cannot: string } | null>(null);

/** What was understood last: the phrase, or null where it was none. */
export const lastHeard = signal<{ phrase: string | null } | null>(null);

/** What cannot be done here and why, as a sentence; empty when all can. */
export const speechLacks = signal("");

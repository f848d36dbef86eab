// The sounds that call a person, and whether this page may make any.
import { signal } from "@preact/signals";

interface Tone {
  hertz: number;
  from_s: number;
  length_s: number;
}

/** Two short tones: a robot asks. */
const ASKS: readonly Tone[] = [
  { hertz: 660, from_s: 0, length_s: 0.22 },
  { hertz: 880, from_s: 0.16, length_s: 0.22 },
];
/** Four that swing, three times as loud: a robot needs a hand now. */
const NOW: readonly Tone[] = [
  { hertz: 988, from_s: 0, length_s: 0.16 },
  { hertz: 740, from_s: 0.15, length_s: 0.16 },
  { hertz: 988, from_s: 0.3, length_s: 0.16 },
  { hertz: 1319, from_s: 0.45, length_s: 0.35 },
];
const CALM_GAIN = 0.25;
const LOUD_GAIN = 0.8;

const CALM_PATTERN = [200, 120, 200];
const URGENT_PATTERN = [500, 150, 500, 150, 800];

/** The browser lets no page be heard that nobody has touched: whether that is so here. */
export const soundBlocked = signal(false);

let context: AudioContext | null = null;

/** Call somebody: by sound, and by vibration where the device has it. */
export function playCall(urgent: boolean): void {
  navigator.vibrate?.(urgent ? URGENT_PATTERN : CALM_PATTERN);
  void play(urgent);
}

/** Play a call; resolves with whether it was really played, up to its end. */
export async function play(urgent: boolean): Promise<boolean> {
  const tones = urgent ? NOW : ASKS;
  if (!(await unlock())) return false;
  const audio = audioContext();
  const begun = audio.currentTime;
  const ended = tones.map((tone) => sound(audio, tone, urgent ? LOUD_GAIN : CALM_GAIN));
  await Promise.all(ended);
  return audio.state === "running" && audio.currentTime > begun;
}

const GRANTED_WITHIN_MS = 400;

/** Have the browser let this page be heard, where it does; resolves with whether it does. */
export async function unlock(): Promise<boolean> {
  const audio = audioContext();
  if (audio.state !== "running") {
    // Where nobody has touched the page this waits for that: it neither resolves nor rejects.
    const waited = new Promise((resolve) => window.setTimeout(resolve, GRANTED_WITHIN_MS));
    await Promise.race([audio.resume().catch(() => undefined), waited]);
  }
  soundBlocked.value = audio.state !== "running";
  return !soundBlocked.value;
}

function sound(audio: AudioContext, { hertz, from_s, length_s }: Tone, gain: number): Promise<void> {
  const tone = new OscillatorNode(audio, { frequency: hertz });
  const volume = new GainNode(audio, { gain: 0 });
  const from = audio.currentTime + from_s;
  volume.gain.setValueAtTime(0, from);
  volume.gain.linearRampToValueAtTime(gain, from + 0.02);
  volume.gain.exponentialRampToValueAtTime(0.001, from + length_s);
  tone.connect(volume).connect(audio.destination);
  tone.start(from);
  tone.stop(from + length_s);
  return new Promise((resolve) => {
    tone.onended = () => resolve();
  });
}

function audioContext(): AudioContext {
  if (context === null || context.state === "closed") {
    context = new AudioContext();
    context.addEventListener("statechange", () => {
      if (context?.state === "running") soundBlocked.value = false;
    });
  }
  return context;
}

// The first touch is what browsers wait for, whatever it is for. Not its beginning: what says that nothing is heard
// goes then, and would move from under the finger what is being touched.
for (const kind of ["click", "keydown"]) {
  window.addEventListener(kind, () => context !== null && soundBlocked.value && void unlock(), { passive: true });
}

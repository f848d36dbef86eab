// Says one text at a time: with the service's sound, or with the browser's own voice.
import { voice } from "../state/preferences";
import { sayInBrowser } from "./browser_voice";
import { t } from "../words/words";
import { translated } from "../words/said";

let stop: AbortController | null = null;

/** Say it in the reader's language where there is a voice of it, else as the service says it; resolves when it is said, was cut off, or there is nothing to say it with. */
export async function say(text: string, audio: string | null): Promise<void> {
  hush();
  const mine = new AbortController();
  stop = mine;
  const told = translated(text);
  // What is only there in English is said in English.
  const inBrowser = () => (told === null ? sayInBrowser(text, mine.signal, "en") : sayInBrowser(told, mine.signal));
  const fromService = () => (audio === null ? Promise.reject(new Error(t("no sound"))) : play(audio, mine.signal));
  // The service speaks English alone.
  const [first, second] = voice.value === "browser" || told !== null ? [inBrowser, fromService] : [fromService, inBrowser];
  // What cannot be said is shown: its text stands on the card in any case.
  await first()
    .catch(() => (mine.signal.aborted ? undefined : second()))
    .catch(() => undefined);
}

/** Be silent at once. */
export function hush(): void {
  stop?.abort();
  stop = null;
}

function play(address: string, signal: AbortSignal): Promise<void> {
  const sound = new Audio(address);
  return new Promise((resolve, reject) => {
    sound.onended = () => resolve();
    sound.onerror = () => reject(new Error(t("The sound cannot be played.")));
    signal.addEventListener("abort", () => {
      sound.pause();
      resolve();
    });
    sound.play().catch(reject);
  });
}

// The browser's own voice, where it has one: an option, never a need.
import { t } from "../words/words";
import { language } from "../words/language";

/** The voices that can say a language, the page's unless told, without leaving this device where there is a choice. */
export function browserVoices(spoken = language): SpeechSynthesisVoice[] {
  if (!("speechSynthesis" in window)) return [];
  const able = speechSynthesis.getVoices().filter((each) => each.lang.startsWith(spoken));
  const local = able.filter((each) => each.localService);
  return local.length > 0 ? local : able;
}

/** Say a text; resolves when it is said, rejects when it cannot be. */
export function sayInBrowser(text: string, signal: AbortSignal, spoken = language): Promise<void> {
  return new Promise((resolve, reject) => {
    const [voice] = browserVoices(spoken);
    if (voice === undefined) {
      reject(new Error(t("This browser has no voice.")));
      return;
    }
    const utterance = new SpeechSynthesisUtterance(text);
    utterance.voice = voice;
    utterance.lang = voice.lang;
    utterance.onend = () => resolve();
    utterance.onerror = () => (signal.aborted ? resolve() : reject(new Error(t("This browser's voice failed."))));
    signal.addEventListener("abort", () => speechSynthesis.cancel(), { once: true });
    speechSynthesis.speak(utterance);
  });
}

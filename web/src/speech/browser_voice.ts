// The browser's own voice, where it has one: an option, never a need.

/** The voices that can say English, without leaving this device where there is a choice. */
export function browserVoices(): SpeechSynthesisVoice[] {
  if (!("speechSynthesis" in window)) return [];
  const english = speechSynthesis.getVoices().filter((each) => each.lang.startsWith("en"));
  const local = english.filter((each) => each.localService);
  return local.length > 0 ? local : english;
}

/** Say a text; resolves when it is said, rejects when it cannot be. */
export function sayInBrowser(text: string, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const [voice] = browserVoices();
    if (voice === undefined) {
      reject(new Error("This browser has no voice."));
      return;
    }
    const utterance = new SpeechSynthesisUtterance(text);
    utterance.voice = voice;
    utterance.onend = () => resolve();
    utterance.onerror = () => (signal.aborted ? resolve() : reject(new Error("This browser's voice failed.")));
    signal.addEventListener("abort", () => speechSynthesis.cancel(), { once: true });
    speechSynthesis.speak(utterance);
  });
}

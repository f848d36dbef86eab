// The browser's own recognizer of speech, where it has one that works on this device: what people say goes nowhere else.
import { t } from "../words/words";

/** What people ask for in words of their own is understood in English alone. */
export const ENGLISH = "en-US";

interface Recognition extends EventTarget {
  lang: string;
  processLocally: boolean;
  start(): void;
  abort(): void;
}

interface RecognitionClass {
  new (): Recognition;
  /** Absent where recognition is some server's. */
  available?: (options: { langs: readonly string[]; processLocally: boolean }) => Promise<string>;
}

interface Heard extends Event {
  results: ArrayLike<ArrayLike<{ transcript: string }>>;
}

function recognitionHere(): RecognitionClass | undefined {
  return (window as unknown as { SpeechRecognition?: RecognitionClass }).SpeechRecognition;
}

/** Whether speech is recognized here without leaving this device. */
export async function canHear(language: string): Promise<boolean> {
  const here = recognitionHere();
  if (here?.available === undefined) return false;
  return (await here.available({ langs: [language], processLocally: true }).catch(() => "unavailable")) === "available";
}

/** What is said next; empty where nothing was understood. Rejects where nobody may listen. */
export function hear(signal: AbortSignal, language: string): Promise<string> {
  return new Promise((resolve, reject) => {
    const here = recognitionHere();
    if (here === undefined) {
      reject(new Error(t("This browser does not recognize speech.")));
      return;
    }
    const recognition = new here();
    recognition.lang = language;
    recognition.processLocally = true;
    recognition.addEventListener("result", (event) => resolve((event as Heard).results[0]?.[0]?.transcript ?? ""));
    recognition.addEventListener("error", (event) => {
      const { error } = event as Event & { error?: string };
      if (error === "no-speech" || error === "aborted") resolve("");
      else reject(new Error(t("The microphone cannot be used: type instead.")));
    });
    // After a result this changes nothing.
    recognition.addEventListener("end", () => resolve(""));
    signal.addEventListener("abort", () => recognition.abort(), { once: true });
    recognition.start();
  });
}

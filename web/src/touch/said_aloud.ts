// What a robot's touch screen shows is said, too, where the browser has a voice and sound is on.
import { useEffect, useState } from "preact/hooks";
import { browserVoices, sayInBrowser } from "../speech/browser_voice";
import { soundOn } from "../state/preferences";

/** Say a text when it is shown; what was being said then is not said any further. */
export function useSaidAloud(text: string): void {
  const on = soundOn.value;
  useEffect(() => {
    if (!on || text === "" || browserVoices().length === 0) return undefined;
    const stop = new AbortController();
    void sayInBrowser(text, stop.signal).catch(() => undefined);
    return () => stop.abort();
  }, [text, on]);
}

/** Whether the browser has a voice; some come after the page. */
export function useHasVoice(): boolean {
  const [has, setHas] = useState(() => browserVoices().length > 0);
  useEffect(() => {
    if (!("speechSynthesis" in window)) return undefined;
    const look = () => setHas(browserVoices().length > 0);
    speechSynthesis.addEventListener("voiceschanged", look);
    return () => speechSynthesis.removeEventListener("voiceschanged", look);
  }, []);
  return has;
}

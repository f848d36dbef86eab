// What a robot's touch screen shows is said, too, where the browser has a voice and sound is on.
import { useEffect } from "preact/hooks";
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

// That a page hears nothing of its robots any more, whatever keeps it: what they did last says nothing of now.
import { useEffect, useState } from "preact/hooks";
import { OLD_S } from "../building/standing";

const AGAIN_MS = 1_000;

/** For how many whole seconds nothing has come since `heard` (as `performance.now()`); 0 while that is not long. */
export function silence(heard: number, now: number): number {
  const silent_s = (now - heard) / 1000;
  return silent_s < OLD_S ? 0 : Math.floor(silent_s);
}

/** The same at this moment, renewed every second. */
export function useSilence(heard: number): number {
  const [now, setNow] = useState(() => performance.now());
  useEffect(() => {
    const timer = window.setInterval(() => setNow(performance.now()), AGAIN_MS);
    return () => window.clearInterval(timer);
  }, []);
  return silence(heard, now);
}

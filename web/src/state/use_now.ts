// The time, for what is said of how long ago something was.
import { useEffect, useState } from "preact/hooks";

const AGAIN_MS = 30_000;

/** `Date.now()`, renewed every half minute. */
export function useNow(): number {
  const [now, setNow] = useState(Date.now);
  useEffect(() => {
    const timer = window.setInterval(() => setNow(Date.now()), AGAIN_MS);
    return () => window.clearInterval(timer);
  }, []);
  return now;
}

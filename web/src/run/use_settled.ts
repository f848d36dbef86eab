// A value once it has stayed the same for a while: what somebody types is not searched for letter by letter.
import { useEffect, useState } from "preact/hooks";

const SETTLED_MS = 250;

export function useSettled<T>(value: T): T {
  const [settled, setSettled] = useState(value);
  useEffect(() => {
    const timer = window.setTimeout(() => setSettled(() => value), SETTLED_MS);
    return () => window.clearTimeout(timer);
  }, [value]);
  return settled;
}

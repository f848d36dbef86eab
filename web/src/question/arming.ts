// A key or a tap that was meant for what was there a moment ago must not answer a question that
// nobody can have read yet: each prompt is shown for a moment before it takes answers.
import { useEffect, useState } from "preact/hooks";

export const ARMED_AFTER_MS = 500;

export interface Arming {
  /** Whether the prompt takes answers. */
  readonly armed: boolean;
  /** Whether somebody tried to answer it before. */
  readonly tooEarly: boolean;
  noteTooEarly(): void;
}

/** How far it is with one prompt; each further one starts anew. */
export function useArming(prompt: string | null): Arming {
  const [armed, setArmed] = useState<string | null>(null);
  const [early, setEarly] = useState<string | null>(null);
  // An effect runs once the prompt has been drawn: the time before that does not count.
  useEffect(() => {
    if (prompt === null) return;
    const timer = window.setTimeout(() => setArmed(prompt), ARMED_AFTER_MS);
    return () => window.clearTimeout(timer);
  }, [prompt]);
  return {
    armed: prompt !== null && armed === prompt,
    tooEarly: prompt !== null && early === prompt,
    noteTooEarly: () => setEarly(prompt),
  };
}

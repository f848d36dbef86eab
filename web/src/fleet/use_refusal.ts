// Why a robot did not do what an operator wanted, as long as the robot is as it was then.
import { useEffect, useState } from "preact/hooks";

export interface Refused {
  text: string;
  /** How the robot was as soon as that was read after it was refused; null until then. */
  state: string | null;
}

export const NOT_REFUSED: Refused = { text: "", state: null };

/** What is left of it once the robot is seen to be in a state: its reason is over when that has changed. */
export function refusedStill(refused: Refused, state: string): Refused {
  if (refused.text === "" || refused.state === state) return refused;
  return refused.state === null ? { ...refused, state } : NOT_REFUSED;
}

/** `read` is another object each time the `state` was read. */
export function useRefusal(state: string, read: object): [string, (text: string) => void] {
  const [refused, setRefused] = useState(NOT_REFUSED);
  useEffect(() => setRefused((before) => refusedStill(before, state)), [read]);
  return [refused.text, (text) => setRefused({ text, state: null })];
}

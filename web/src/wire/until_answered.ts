// What is sent under a key, once more while its answer does not come: it may have been done all the same.
import { Refusal } from "./rest";

/** So long a service that begins anew is away. */
const PAUSES_MS: readonly number[] = [1_000, 2_000, 4_000, 8_000];

/** A proxy says so of a service that is not there, and knows as little what that has done. */
const NOT_THERE: ReadonlySet<number> = new Set([502, 503, 504]);

/** What was answered; null where it is not known whether it was done. `lost` is told of each answer that did not come. */
export async function untilAnswered<T>(
  send: () => Promise<T>,
  lost: () => void,
  wait: (ms: number) => Promise<void> = pause,
): Promise<T | null> {
  for (const pauseMs of [...PAUSES_MS, null]) {
    try {
      return await send();
    } catch (error) {
      if (isAnswer(error)) throw error;
      lost();
    }
    if (pauseMs !== null) await wait(pauseMs);
  }
  return null;
}

/** Whether the service has refused it: anything else says nothing of what it has done. */
function isAnswer(error: unknown): boolean {
  return error instanceof Refusal && !error.later && !NOT_THERE.has(error.status);
}

const pause = (ms: number) => new Promise<void>((then) => setTimeout(then, ms));

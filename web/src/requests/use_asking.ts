// One thing that somebody asks for: sent, then refused with another time, or booked, or nobody knows.
import { useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { Refusal } from "../wire/rest";
import { untilAnswered } from "../wire/until_answered";
import type { RequestView } from "../wire/types";

export type RequestDocument = Readonly<Record<string, unknown>>;

export type Asking =
  | { phase: "nothing" }
  /** `lost`: an answer has not come, and it is sent once more. */
  | { phase: "sending"; lost: boolean }
  /** No answer has come: it may be booked or not. Under the same key it is booked once at most. */
  | { phase: "unknown"; request: RequestDocument; key: string }
  /** `by`: when it could be met instead (the building's clock); null where that is never, or was not what kept it. */
  | { phase: "refused"; request: RequestDocument; why: string; by: number | null }
  /** `request` as it was booked. */
  | { phase: "booked"; request: RequestView };

export interface UseAsking {
  asking: Asking;
  /** The very request of which it is not known whether it is booked goes under the same key once more. */
  ask: (request: RequestDocument) => Promise<void>;
  forget: () => void;
}

export function useAsking(site: string): UseAsking {
  const [asking, setAsking] = useState<Asking>({ phase: "nothing" });
  const ask = async (request: RequestDocument) => {
    // Whoever says yes twice wants it once.
    if (asking.phase === "sending") return;
    const key = asking.phase === "unknown" && asking.request === request ? asking.key : crypto.randomUUID();
    setAsking({ phase: "sending", lost: false });
    const send = () => rest.makeRequest(site, request, key);
    setAsking(
      await untilAnswered(send, () => setAsking({ phase: "sending", lost: true })).then(
        (booked): Asking => (booked === null ? { phase: "unknown", request, key } : { phase: "booked", request: booked }),
        (error: Error) => refusedBy(error, request),
      ),
    );
  };
  return { asking, ask, forget: () => setAsking({ phase: "nothing" }) };
}

/** What was booked, as far as it is known to have come; null where nothing was. */
export function followed(asking: Asking, requests: readonly RequestView[] | null): RequestView | null {
  if (asking.phase !== "booked") return null;
  const { name } = asking.request;
  // One that was refused before it was asked for otherwise has the same name.
  return requests?.find((each) => each.name === name && each.status !== "refused") ?? asking.request;
}

function refusedBy(error: Error, request: RequestDocument): Asking {
  const refusal = error instanceof Refusal ? error : null;
  const by = refusal?.nextPossible?.[1] ?? null;
  return { phase: "refused", request, why: refusal?.why ?? error.message, by };
}

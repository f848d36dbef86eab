// One thing that somebody asks for: sent, then refused with another time, or booked.
import { useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { Refusal } from "../wire/rest";
import type { RequestView } from "../wire/types";

export type RequestDocument = Readonly<Record<string, unknown>>;

export type Asking =
  | { phase: "nothing" }
  | { phase: "sending" }
  /** `by`: when it could be met instead (the building's clock); null where that is never, or was not what kept it. */
  | { phase: "refused"; request: RequestDocument; why: string; by: number | null }
  /** `request` as it was booked. */
  | { phase: "booked"; request: RequestView };

export interface UseAsking {
  asking: Asking;
  ask: (request: RequestDocument) => Promise<void>;
  forget: () => void;
}

export function useAsking(site: string): UseAsking {
  const [asking, setAsking] = useState<Asking>({ phase: "nothing" });
  const ask = async (request: RequestDocument) => {
    setAsking({ phase: "sending" });
    setAsking(
      await rest.makeRequest(site, request).then(
        (booked): Asking => ({ phase: "booked", request: booked }),
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

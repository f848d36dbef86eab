// One thing that somebody asks for: sent, then refused with another time, or booked.
import { useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { Refusal } from "../wire/rest";

export type RequestDocument = Readonly<Record<string, unknown>>;

export type Asking =
  | { phase: "nothing" }
  | { phase: "sending" }
  /** `by`: when it could be met instead (the building's clock); null where that is never, or was not what kept it. */
  | { phase: "refused"; request: RequestDocument; why: string; by: number | null }
  | { phase: "booked"; name: string };

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
        ({ name }): Asking => ({ phase: "booked", name }),
        (error: Error) => refusedBy(error, request),
      ),
    );
  };
  return { asking, ask, forget: () => setAsking({ phase: "nothing" }) };
}

function refusedBy(error: Error, request: RequestDocument): Asking {
  const refusal = error instanceof Refusal ? error : null;
  const by = refusal?.nextPossible?.[1] ?? null;
  return { phase: "refused", request, why: refusal?.why ?? error.message, by };
}

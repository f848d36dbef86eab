// What may be said of a node now, as the service has it: asked for again whenever that may have changed.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../../wire/rest";
import type { NodeSteeringView } from "../../wire/types";
import type { RunState } from "../fold";

export function useOffers(run: string, node: string | null, state: RunState, wanted: boolean): NodeSteeringView | null {
  const [offers, setOffers] = useState<NodeSteeringView | null>(null);
  useEffect(() => {
    if (node === null || !wanted) {
      setOffers(null);
      return;
    }
    let current = true;
    rest.steeringOffers(run, node).then(
      (found) => current && setOffers(found),
      () => current && setOffers(null),
    );
    return () => {
      current = false;
    };
  }, [run, node, wanted, state.leaves, state.abandoned, state.status, state.steering]);
  return offers?.node === node ? offers : null;
}

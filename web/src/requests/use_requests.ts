// The requests of one site, and its clock, read anew every few seconds.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import type { FleetView, RequestView } from "../wire/types";
import { whyNotDone } from "../words/said";

const AGAIN_MS = 2_000;

export interface Requests {
  /** Null until they were read. */
  requests: readonly RequestView[] | null;
  fleet: FleetView | null;
  /** When they were read last, as `performance.now()`. */
  heard: number;
  failure: string;
}

const NOTHING: Requests = { requests: null, fleet: null, heard: 0, failure: "" };

/** Also how to read them at once. */
export function useRequests(site: string, againMs = AGAIN_MS): Requests & { again: () => void } {
  const [found, setFound] = useState<Requests>(NOTHING);
  const [asked, setAsked] = useState(0);
  useEffect(() => {
    let current = true;
    let timer = 0;
    const read = async () => {
      await Promise.all([rest.requests(site), rest.fleet(site)]).then(
        ([requests, fleet]) => current && setFound({ requests, fleet, heard: performance.now(), failure: "" }),
        (error: Error) => current && setFound((before) => ({ ...before, failure: whyNotDone(error) })),
      );
      if (current) timer = window.setTimeout(() => void read(), againMs);
    };
    void read();
    return () => {
      current = false;
      window.clearTimeout(timer);
    };
  }, [site, asked, againMs]);
  return { ...found, again: () => setAsked((count) => count + 1) };
}

// The statistics that a query finds, read anew when a run ends or another is asked for.
import { useEffect, useState } from "preact/hooks";
import { onEvent, onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { Event, Statistics } from "../wire/types";
import { whyNotDone } from "../words/said";

const CHANGES: ReadonlySet<Event["type"]> = new Set(["run_started", "run_finished", "run_failed", "run_aborted"]);

export function useStatistics(query: string): { found: Statistics | null; failure: string } {
  const [state, setState] = useState<{ found: Statistics | null; failure: string }>({ found: null, failure: "" });
  useEffect(() => {
    let newest = 0;
    const read = () => {
      const mine = ++newest;
      rest.statistics(query).then(
        (found) => {
          if (mine === newest) setState({ found, failure: "" });
        },
        (error: Error) => {
          if (mine === newest) setState((known) => ({ ...known, failure: whyNotDone(error) }));
        },
      );
    };
    const stops = [onSnapshot(read), onEvent((event) => CHANGES.has(event.type) && read())];
    read();
    return () => {
      newest = -1;
      for (const stop of stops) stop();
    };
  }, [query]);
  return state;
}

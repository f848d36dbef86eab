// One page of the list of runs, read anew whenever a run begins or changes its state.
import { useEffect, useState } from "preact/hooks";
import { onEvent, onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { Event, RunStatus, RunSummary } from "../wire/types";
import { whyNotDone } from "../words/said";

export const PAGE_SIZE = 20;

const CHANGES: ReadonlySet<Event["type"]> = new Set([
  "run_started",
  "run_paused",
  "run_resumed",
  "run_finished",
  "run_failed",
  "run_aborted",
]);

export interface RunsPage {
  /** Null until they were read. */
  runs: readonly RunSummary[] | null;
  /** Whether there are older ones. */
  more: boolean;
  failure: string;
}

/** The runs of a page that are of some statuses, and that a query finds. */
export function useRunsPage(statuses: readonly RunStatus[], page: number, query: string): RunsPage {
  const [found, setFound] = useState<RunsPage>({ runs: null, more: false, failure: "" });
  useEffect(() => {
    let current = true;
    const read = () => {
      // One more than is shown tells whether there are more.
      rest.runs(PAGE_SIZE + 1, page * PAGE_SIZE, statuses, query).then(
        (runs) => {
          const shown = { runs: runs.slice(0, PAGE_SIZE), more: runs.length > PAGE_SIZE, failure: "" };
          if (current) setFound(shown);
        },
        (error: Error) => {
          if (current) setFound((before) => ({ ...before, failure: whyNotDone(error) }));
        },
      );
    };
    const stop = [onSnapshot(read), onEvent((event) => CHANGES.has(event.type) && read())];
    read();
    return () => {
      current = false;
      stop.forEach((each) => each());
    };
  }, [statuses, page, query]);
  return found;
}

// One page of the list of issues, read anew whenever one is raised or its dialogue ends.
import { useEffect, useState } from "preact/hooks";
import { onEvent, onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { Event, IssueSummary } from "../wire/types";
import { whyNotDone } from "../words/said";

export const PAGE_SIZE = 30;

const CHANGES: ReadonlySet<Event["type"]> = new Set(["issue_raised", "dialogue_opened", "dialogue_closed"]);

export interface IssuesPage {
  /** Null until they were read. */
  readonly issues: readonly IssueSummary[] | null;
  /** Whether there are older ones. */
  readonly more: boolean;
  readonly failure: string;
}

/** The issues before `before`, the newest for null, that a query finds. */
export function useIssuesPage(query: string, before: number | null): IssuesPage {
  const [found, setFound] = useState<IssuesPage>({ issues: null, more: false, failure: "" });
  useEffect(() => {
    let newest = 0;
    const read = () => {
      const mine = ++newest;
      // One more than is shown tells whether there are more.
      rest.issues(query, before, PAGE_SIZE + 1).then(
        (issues) => {
          if (mine === newest)
            setFound({ issues: issues.slice(0, PAGE_SIZE), more: issues.length > PAGE_SIZE, failure: "" });
        },
        (error: Error) => {
          if (mine === newest) setFound((known) => ({ ...known, failure: whyNotDone(error) }));
        },
      );
    };
    const stop = [onSnapshot(read), onEvent((event) => CHANGES.has(event.type) && read())];
    read();
    return () => {
      newest = -1;
      stop.forEach((each) => each());
    };
  }, [query, before]);
  return found;
}

// Why something cannot be done as it is asked for, and when it could be.
import type { Asking, RequestDocument } from "./use_asking";
import { type SiteClock, when } from "./when";

interface RefusedProps {
  refused: Extract<Asking, { phase: "refused" }>;
  clock: SiteClock;
  ask: (request: RequestDocument) => void;
}

export function Refused({ refused: { request, why, by }, clock, ask }: RefusedProps) {
  return (
    <div class="refused">
      <div role="alert">
        <p class="mistake">{refusedInShort(by)}</p>
        {by !== null && <p>No robot gets it done so soon.</p>}
        {by === null && <p>{asSentence(why)}</p>}
      </div>
      {by !== null && (
        <details class="small">
          <summary>Why not</summary>
          <p>{asSentence(why)}</p>
        </details>
      )}
      {by !== null && (
        <button class="button primary" type="button" onClick={() => ask({ ...request, latest_s: by })}>
          Ask for it {when(by, clock, new Date())} instead
        </button>
      )}
    </div>
  );
}

/** The same for whoever hears it. */
export function refusedInShort(by: number | null): string {
  return by === null ? "That cannot be done." : "That cannot be done by then.";
}

function asSentence(why: string): string {
  const text = why.charAt(0).toUpperCase() + why.slice(1);
  return /[.?!]$/.test(text) ? text : `${text}.`;
}

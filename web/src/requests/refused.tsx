// Why something cannot be done as it is asked for, and when it could be.
import type { Asking, RequestDocument } from "./use_asking";
import { type SiteClock, when } from "./when";
import { t } from "../words/words";
import { ToldReason } from "../words/told";

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
        {by !== null && <p>{t("No robot gets it done so soon.")}</p>}
        {by === null && <p><ToldReason text={why} /></p>}
      </div>
      {by !== null && (
        <details class="small">
          <summary>{t("Why not")}</summary>
          <p><ToldReason text={why} /></p>
        </details>
      )}
      {by !== null && (
        <button class="button primary" type="button" onClick={() => ask({ ...request, latest_s: by })}>
          {t("Ask for it {when} instead", { when: when(by, clock, new Date()) })}
        </button>
      )}
    </div>
  );
}

/** The same for whoever hears it. */
export function refusedInShort(by: number | null): string {
  return by === null ? t("That cannot be done.") : t("That cannot be done by then.");
}

// What may be said of one node now: a button for each, with what comes of it, and why the rest may not.
import { useId } from "preact/hooks";
import { plain } from "../../tree/words";
import type { NodeSteeringView, SteerNodeRequest } from "../../wire/types";
import { sentence } from "../run_words";
import { ACT_WORDS } from "./steering_words";
import { said } from "../../words/said";
import { Told } from "../../words/told";
import { t } from "../../words/words";

interface NodeMenuProps {
  offers: NodeSteeringView;
  busy: boolean;
  say(act: SteerNodeRequest["act"]): void;
}

/** That something which was never said cannot be taken back needs no words. */
const GOES_WITHOUT_SAYING: ReadonlySet<string> = new Set(["go_on", "remove_breakpoint", "not_next"]);

export function NodeMenu({ offers, busy, say }: NodeMenuProps) {
  const id = useId();
  const refused = offers.refused.filter(({ act }) => !GOES_WITHOUT_SAYING.has(act));
  return (
    <div class="node-menu" role="group" aria-label={t("Steer {name}", { name: plain(offers.name) })}>
      <h3>{plain(offers.name)}</h3>
      {offers.offered.length === 0 && <p class="quiet small">{t("Nothing can be said of it now.")}</p>}
      <ul>
        {offers.offered.map(({ act, effect }) => (
          <li key={act}>
            <button type="button" class="button" disabled={busy} aria-describedby={`${id}-${act}`} onClick={() => say(act)}>
              {ACT_WORDS[act]}
            </button>
            <span id={`${id}-${act}`} class="small quiet">
              <Told text={effect} />
            </span>
          </li>
        ))}
      </ul>
      {refused.length > 0 && (
        <details class="small">
          <summary>{t("What cannot be said now")}</summary>
          <ul>
            {refused.map(({ act, why }) => (
              <li key={act}>
                <b>{ACT_WORDS[act]}</b>: {sentence(said(why))}
              </li>
            ))}
          </ul>
        </details>
      )}
    </div>
  );
}

// Steering: what may be said of the selected node, how much the robots may do alone, and where they wait.
import { useId, useState } from "preact/hooks";
import { may, whyNot } from "../../state/access";
import { helperName } from "../../state/preferences";
import { plain } from "../../tree/words";
import * as rest from "../../wire/rest";
import type { NodeView } from "../../wire/types";
import { ended, type RunState } from "../fold";
import { sentence } from "../run_words";
import { AutonomyChoice } from "./autonomy_choice";
import { NodeMenu } from "./node_menu";
import { useOffers } from "./use_offers";
import { whyNotDone } from "../../words/said";
import { t } from "../../words/words";
import "./steering_panel.css";

interface SteeringPanelProps {
  state: RunState;
  selected: NodeView | null;
  /** Whether the newest moment is shown. */
  newest: boolean;
  onSelect: (path: string) => void;
}

export function SteeringPanel({ state, selected, newest, onSelect }: SteeringPanelProps) {
  const { run } = state.started;
  const going = newest && !ended(state.status);
  const offered = going && may("operator");
  const offers = useOffers(run, selected?.node ?? null, state, offered);
  const [note, setNote] = useState("");
  const [reason, setReason] = useState("");
  const [busy, setBusy] = useState(false);
  const ask = async (request: Promise<unknown>): Promise<boolean> => {
    setBusy(true);
    const refused = await request.then(
      () => "",
      (error: Error) => sentence(whyNotDone(error)),
    );
    setNote(refused);
    setBusy(false);
    if (refused === "") setReason("");
    return refused === "";
  };
  const said = { reason: reason.trim(), helper: helperName.value };
  const { autonomy, breakpoints, preferred } = state.steering;
  // Of a run that is over there is nothing to say where nothing was said.
  if (!going && breakpoints.size === 0 && autonomy === "full") return null;
  return (
    <section class="panel steering" aria-labelledby="steering-title">
      <h2 id="steering-title">{t("Steering")}</h2>
      <AutonomyChoice
        level={autonomy}
        disabled={!offered || busy}
        onChoose={(level) => ask(rest.steer(run, { act: "set_autonomy", level, ...said }))}
      />
      {offered && <Why reason={reason} onInput={setReason} />}
      {offered && selected !== null && offers !== null && (
        <NodeMenu key={selected.node} offers={offers} busy={busy} say={(act) => void ask(rest.steer(run, { act, node: selected.node, ...said }))} />
      )}
      {offered && selected === null && <p class="quiet small">{t("Choose a node of the tree to steer it.")}</p>}
      {preferred !== null && <p class="small">{t("{by} has asked for {name} next.", { by: preferred.by, name: plain(preferred.name) })}</p>}
      {breakpoints.size > 0 && (
        <ul class="steering-breakpoints">
          {[...breakpoints.values()].map(({ node, name, by, reason }) => (
            <li key={node}>
              <button type="button" class="bare link" onClick={() => onSelect(node)}>{t("Breakpoint before {name}", { name: plain(name) })}</button>
              <span class="small quiet">{` ${reason === "" ? t("by {by}", { by }) : t("by {by}: {reason}", { by, reason })}`}</span>
            </li>
          ))}
        </ul>
      )}
      {going && !may("operator") && <p class="quiet small">{whyNot(t("Steering it"), "operator")}</p>}
      <p role="status" class="mistake small">
        {note}
      </p>
    </section>
  );
}

const MOST_CHARACTERS = 200;

/** Kept in the journal with whatever is said next. */
function Why({ reason, onInput }: { reason: string; onInput(reason: string): void }) {
  const id = useId();
  return (
    <div class="steering-row">
      <label class="small" for={id}>{t("Why")}</label>
      <input
        id={id}
        class="input"
        autocomplete="off"
        placeholder={t("if you like")}
        maxLength={MOST_CHARACTERS}
        value={reason}
        onInput={(event) => onInput(event.currentTarget.value)}
      />
    </div>
  );
}

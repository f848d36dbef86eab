// Where a run waits to be let go, with the button for it.
import { useState } from "preact/hooks";
import { may, whyNot } from "../../state/access";
import { helperName } from "../../state/preferences";
import { plain } from "../../tree/words";
import * as rest from "../../wire/rest";
import type { WaitView } from "../../wire/types";
import { sentence } from "../run_words";
import { whyItWaits } from "./steering_words";
import { whyNotDone } from "../../words/said";
import { t } from "../../words/words";
import "./run_waits.css";

interface RunWaitsProps {
  run: string;
  /** What the run is called, with a link to it, where that is not its own page. */
  tree?: string;
  waits: readonly WaitView[];
  /** Whether they can be let go here: in the past nothing can. */
  going: boolean;
}

export function RunWaits({ run, tree, waits, going }: RunWaitsProps) {
  const [note, setNote] = useState("");
  const [busy, setBusy] = useState(false);
  const letGo = (node: string) => {
    setBusy(true);
    setNote("");
    void rest
      .steer(run, { act: "go_on", node, reason: "", helper: helperName.value })
      .catch((error: Error) => setNote(sentence(whyNotDone(error))))
      .then(() => setBusy(false));
  };
  return (
    <div class="run-waits" role="group" aria-label={t("Waits to be let go")}>
      {waits.map((wait) => (
        <div key={wait.node} class="run-wait">
          <p>
            {tree === undefined ? t("The run") : <a href={`/runs/${run}`}>{plain(tree)}</a>} {whyItWaits(wait)}
          </p>
          {going && may("operator") && (
            <button type="button" class="button primary" disabled={busy} aria-label={t("Go on: {name}", { name: plain(wait.name) })} onClick={() => letGo(wait.node)}>{t("Go on")}</button>
          )}
        </div>
      ))}
      {going && !may("operator") && <p class="quiet small">{whyNot(t("Letting it go on"), "operator")}</p>}
      <p role="status" class="mistake small">
        {note}
      </p>
    </div>
  );
}

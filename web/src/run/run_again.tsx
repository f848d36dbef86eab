// Doing a run again as it was asked for: the same tree, world and options, with its seed or another.
import { useState } from "preact/hooks";
import { go } from "../app/router";
import { Confirm } from "../app/confirm";
import { plain } from "../tree/words";
import * as rest from "../wire/rest";
import type { RunRequest } from "../wire/types";
import type { RunState } from "./fold";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

export function RunAgain({ started }: { started: RunState["started"] }) {
  const [asking, setAsking] = useState(false);
  const [mistake, setMistake] = useState("");
  const [seed, setSeed] = useState(String(started.seed));
  const start = async () => {
    setMistake("");
    try {
      const again = { ...(started.options as unknown as RunRequest), seed: Number.parseFloat(seed) };
      go(`/runs/${(await rest.startRun(again)).id}`);
    } catch (error) {
      setMistake(whyNotDone(error));
    }
  };
  return (
    <>
      <button class="button" type="button" onClick={() => setAsking(true)}>
        {t("Run again …")}
      </button>
      {asking && (
        <Confirm
          title={t("Run {tree_name} again?", { tree_name: plain(started.tree_name) })}
          confirm={t("Start the run")}
          harmless
          onCancel={() => setAsking(false)}
          onConfirm={() => void start()}
        >
          <p>{t("With the task tree as it is now, and all else as it was asked for then:")}</p>
          <dl class="run-options">
            {told(started.options).map(([name, value]) => (
              <div key={name}>
                <dt>{plain(name)}</dt>
                <dd>{value}</dd>
              </div>
            ))}
          </dl>
          <div class="field">
            <label for="again-seed">{t("Seed")}</label>
            <input id="again-seed" type="number" min="0" step="1" value={seed} onInput={(event) => setSeed(event.currentTarget.value)} />
          </div>
          <p class="mistake" role="alert">
            {mistake}
          </p>
        </Confirm>
      )}
    </>
  );
}

const NOT_TOLD: ReadonlySet<string> = new Set(["tree", "seed"]);

/** What was asked for, as far as anything was. */
function told(options: object): [string, string][] {
  return Object.entries(options)
    .filter(([name, value]) => !NOT_TOLD.has(name) && !isNothing(value))
    .map(([name, value]) => [name, typeof value === "string" ? plain(value) : JSON.stringify(value)]);
}

function isNothing(value: unknown): boolean {
  return value === null || (typeof value === "object" && Object.keys(value as object).length === 0);
}

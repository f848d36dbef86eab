// The head of a run: what it is, how it goes, and pause, resume and abort.
import { useState } from "preact/hooks";
import { Confirm } from "../app/confirm";
import { may, whyNot } from "../state/access";
import { plain } from "../tree/words";
import * as rest from "../wire/rest";

import { ended, type RunState } from "./fold";
import type { Moment } from "./moment";
import { RunAgain } from "./run_again";
import { clock, sentence, siteName } from "./run_words";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./run_header.css";

const STATUS_WORDS = {
  running: t("running"),
  paused: t("paused"),
  finished: t("finished"),
  failed: t("failed"),
  aborted: t("aborted"),
  unreadable: t("unreadable"),
} as const;

export function RunHeader({ newest, moment }: { newest: RunState; moment: Moment }) {
  const { started, status, result } = newest;
  return (
    <header class="run-header">
      <div class="run-title">
        <h1>
          {plain(started.tree_name)} <span class="quiet">{t("in {world}", { world: plain(started.world) })}</span>
        </h1>
        <p class="run-facts">
          <span class={`badge ${status}`}>{STATUS_WORDS[status]}</span>
          <RunClock moment={moment} />
          <span class="quiet">
            {started.robots.map((robot) => (newest.lost.has(robot) ? `${robot} (lost)` : robot)).join(", ")}
          </span>
          {started.site != null && <span class="quiet">{t("at the site {site_name}", { site_name: siteName({ id: started.site, scene: sceneOf(started) }) })}</span>}
          {started.scenario !== null && <span class="quiet">{t("scenario {scenario}", { scenario: plain(started.scenario) })}</span>}
        </p>
        {result !== null && (status !== "finished" || result.missing.length > 0) && (
          <p class="mistake">{sentence(result.reason)}</p>
        )}
        {result !== null && status === "finished" && result.missing.length === 0 && result.unseen.length > 0 && (
          <p class="quiet">{sentence(result.reason)}</p>
        )}
      </div>
      <div class="run-ways">
        <a class="button" href={`/api/runs/${started.run}/report`} download>{t("Report")}</a>
        <span class="run-exports" role="group" aria-label={t("Export")}>
          <a class="button" href={rest.exportPath(started.run, "csv")} title={t("Its events as a table")} download>{t("CSV")}</a>
          <a class="button" href={rest.exportPath(started.run, "mcap")} title={t("Events, poses and pictures for Foxglove")} download>{t("MCAP")}</a>
        </span>
        {ended(status) && may("operator") && <RunAgain started={started} />}
        {!ended(status) && <RunControls run={started.run} paused={status === "paused"} />}
      </div>
    </header>
  );
}

/** By itself: it runs while all the rest stands still. */
function RunClock({ moment }: { moment: Moment }) {
  return (
    <span class="run-clock">
      <span class="unseen">{t("Run clock")}{" "}</span>
      {clock(moment.end.value)}
    </span>
  );
}

function RunControls({ run, paused }: { run: string; paused: boolean }) {
  const [note, setNote] = useState("");
  const [busy, setBusy] = useState(false);
  const [aborting, setAborting] = useState(false);
  const ask = async (request: (id: string) => Promise<unknown>) => {
    setBusy(true);
    setNote("");
    try {
      await request(run);
    } catch (error) {
      setNote(whyNotDone(error));
    }
    setBusy(false);
  };
  if (!may("operator")) return <p class="quiet small">{whyNot(t("Pausing or aborting it"), "operator")}</p>;
  return (
    <div class="run-controls">
      <p role="status" class="mistake small">
        {note}
      </p>
      {paused ? (
        <button class="button primary" type="button" disabled={busy} onClick={() => void ask(rest.resumeRun)}>{t("Resume")}</button>
      ) : (
        <button class="button" type="button" disabled={busy} onClick={() => void ask(rest.pauseRun)}>{t("Pause")}</button>
      )}
      <button class="button danger" type="button" disabled={busy} onClick={() => setAborting(true)}>{t("Abort …")}</button>
      {aborting && (
        <Confirm
          title={t("Abort this run for good?")}
          confirm={t("Abort the run")}
          cancel={t("Let it go on")}
          onCancel={() => setAborting(false)}
          onConfirm={() => {
            setAborting(false);
            void ask(rest.abortRun);
          }}
        >
          <p>{t("The robot stops, and the run cannot be taken up again.")}</p>
        </Confirm>
      )}
    </div>
  );
}

function sceneOf({ scene }: RunState["started"]): string {
  return typeof scene.name === "string" ? scene.name : "";
}

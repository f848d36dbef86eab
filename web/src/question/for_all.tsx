// One press for several questions, where that is safe; held back for a moment, as it cannot be taken back.
import { useLayoutEffect, useState } from "preact/hooks";
import { helperName } from "../state/preferences";
import * as rest from "../wire/rest";
import type { BatchWayView } from "../wire/types";
import { UNDO_MS } from "./answering";
import { t } from "../words/words";
import { said, whyNotDone } from "../words/said";

export function ForAll({ ways, prompts }: { ways: readonly BatchWayView[]; prompts: readonly string[] }) {
  const [chosen, setChosen] = useState<BatchWayView | null>(null);
  const [mistake, setMistake] = useState("");
  const all = prompts.join(" ");
  // As soon as Undo is on record, and not a frame later: nothing may be sent after it.
  useLayoutEffect(() => {
    if (chosen === null) return;
    const timer = window.setTimeout(() => {
      setChosen(null);
      rest.chooseForAll(chosen.way, all.split(" "), helperName.value).then(
        (became) => setMistake(became.map(({ refused }) => said(refused ?? "")).filter((each) => each !== "").join(" ")),
        (error: Error) => setMistake(whyNotDone(error)),
      );
    }, UNDO_MS);
    return () => window.clearTimeout(timer);
  }, [chosen, all]);
  return (
    <div class="for-all" role="group" aria-label={t("All {prompts} at once", { prompts: prompts.length })}>
      {chosen === null &&
        ways.map((each) => (
          <button key={each.way} type="button" class="button" onClick={() => setChosen(each)}>{t("{label}, all {prompts}", { label: said(each.label), prompts: prompts.length })}</button>
        ))}
      {chosen !== null && (
        <button type="button" class="button" onClick={() => setChosen(null)}>{t("Undo")}</button>
      )}
      <p class="small" role="status">
        {chosen !== null && t("“{label}” is sent for all {prompts} in a moment.", { label: said(chosen.label), prompts: prompts.length })}
        {mistake !== "" && <span class="mistake">{mistake}</span>}
      </p>
    </div>
  );
}

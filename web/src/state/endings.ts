// What became of questions that are gone: said for some seconds, or until dismissed.
import { signal } from "@preact/signals";
import * as rest from "../wire/rest";
import type { CloseReason, DialogueView } from "../wire/types";
import { t } from "../words/words";
import { said } from "../words/said";

export interface Ending {
  id: number;
  dialogue: string;
  run: string;
  robot: string;
  /** The part that it was about; else what the leaf is called. */
  about: string;
  text: string;
}

const SHOWN_MS = 15_000;
const MOST = 3;

export const endings = signal<readonly Ending[]>([]);

let count = 0;

/** Say how a question ended, or what became of an answer to it. */
export function tellEnding(
  { dialogue, run, robot, object, name }: Pick<DialogueView, "dialogue" | "run" | "robot" | "object" | "name">,
  text: string,
): void {
  const ending = { id: ++count, dialogue, run, robot, about: object ?? name, text };
  // One line a dialogue: what came last says all.
  const others = endings.value.filter((each) => each.dialogue !== dialogue);
  endings.value = [...others, ending].slice(-MOST);
  window.setTimeout(() => dismissEnding(ending.id), SHOWN_MS);
}

export function dismissEnding(id: number): void {
  if (endings.value.some((each) => each.id === id)) {
    endings.value = endings.value.filter((each) => each.id !== id);
  }
}

/** Find out what became of a question that closed while nobody listened, and say it. */
export async function tellHowItEnded(gone: DialogueView): Promise<void> {
  const found = await rest.dialogue(gone.dialogue).catch(() => null);
  const by = found?.answered_by ?? null;
  if (found?.reason === "resolved" && by !== null)
    tellEnding(gone, t("It was closed meanwhile; {by} had answered.", { by }));
  else tellEnding(gone, closing((found?.reason ?? "aborted") as CloseReason, null, gone.interrupts));
}

/** Why a dialogue closed, in words; `statement` is what the robot said last, `waited` whether it waited for an answer. */
export function closing(reason: CloseReason, statement: string | null, waited: boolean): string {
  const last = statement === null ? "" : ` ${t("“{text}”", { text: said(statement) })}`;
  switch (reason) {
    case "resolved":
      return t("Settled.{last}", { last });
    case "withdrawn":
      return t("No longer needed, by what the robot sees.{last}", { last });
    case "gave_up":
      return t("Closed: no help was seen.{last}", { last });
    case "left_out":
      return t("Settled.{last}", { last });
    case "aborted":
      return waited
        ? t("No longer needed: the robot has stopped this task.")
        : t("No longer needed: the robot did not wait for an answer.");
  }
}

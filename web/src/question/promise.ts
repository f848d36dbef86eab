// What a helper may say of help that was promised: that it is done, or that they cannot after all.
import { signal } from "@preact/signals";
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import type { Question } from "../state/questions";
import { command, connection } from "../state/service";
import { t } from "../words/words";
import { whyNotDone } from "../words/said";

export type Word = "done" | "take_back";

/** What was said of which dialogue's help and is still on its way. */
export const onItsWay = signal<{ dialogue: string; word: Word } | null>(null);
/** Why the last word was not taken, by dialogue. */
export const wordMistakes = signal<ReadonlyMap<string, string>>(new Map());

type Promised = Pick<Question, "help">;

/** Whether the robot would look at once if this helper said that it is done. */
export function maySayDone({ help }: Promised): boolean {
  return may("helper") && help !== null && help.at_a_word;
}

/** Only who promised the help can take that back. */
export function mayTakeBack({ help }: Promised): boolean {
  return may("helper") && help !== null && help.helper === helperName.value;
}

/** Say it, unless that is pointless now; whether it was sent. */
export function say(question: Question, word: Word): boolean {
  const { dialogue, help } = question;
  const allowed = word === "done" ? maySayDone(question) && help?.reported_by === null : mayTakeBack(question);
  if (!allowed || connection.peek() !== "connected" || onItsWay.peek() !== null) return false;
  note(dialogue, null);
  onItsWay.value = { dialogue, word };
  void command({ type: word, dialogue })
    .catch((error: Error) => note(dialogue, t("That was not taken: {message}", { message: whyNotDone(error) })))
    .finally(() => {
      onItsWay.value = null;
    });
  return true;
}

function note(dialogue: string, mistake: string | null): void {
  const next = new Map(wordMistakes.value);
  next.delete(dialogue);
  if (mistake !== null) next.set(dialogue, mistake);
  wordMistakes.value = next;
}

// Who is on a question: a claim is made when a helper begins to act on a card, and each activity
// renews its lease. It tells the others; it never keeps them from answering.
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import { dialogueOf, type Question } from "../state/questions";
import { command, connection } from "../state/service";

const RENEW_AFTER_MS = 10_000;

let last: { dialogue: string; at: number } | null = null;

/** Note that this helper does something on a card. */
export function actOn(question: Question): void {
  const { dialogue } = question;
  if (!may("helper") || connection.value !== "connected" || isOthers(dialogueOf(dialogue))) return;
  if (last?.dialogue === dialogue && performance.now() - last.at < RENEW_AFTER_MS) return;
  void claim(dialogue, false);
}

/** Claim a question, if need be from somebody else. */
export async function claim(dialogue: string, takeOver: boolean): Promise<void> {
  if (last !== null && last.dialogue !== dialogue) release(last.dialogue);
  last = { dialogue, at: performance.now() };
  await command({ type: "claim", dialogue, take_over: takeOver }).catch(() => {
    last = null;
  });
}

/** Let the others know that this helper is no longer on a question. */
export function release(dialogue: string): void {
  if (last?.dialogue === dialogue) last = null;
  if (dialogueOf(dialogue)?.claimed_by !== helperName.value) return;
  // A lease that ended by itself meanwhile is as good as released.
  command({ type: "release", dialogue }).catch(() => undefined);
}

function isOthers(question: Question | undefined): boolean {
  return question !== undefined && question.claimed_by !== null && question.claimed_by !== helperName.value;
}

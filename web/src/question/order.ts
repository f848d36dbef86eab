// In which order a helper has the open questions before them.
import type { Question } from "../state/questions";
import { isTurnOf } from "./turn";

type Ordered = Pick<Question, "dialogue" | "prompt" | "claimed_by" | "opened">;

/** What this helper is on, what they are asked, what others are asked, what others are on; each most urgent first.
 *
 * `dueAt`: when nobody waits for an answer any more, on one clock for all; Infinity for never.
 */
export function inOrder<T extends Ordered>(open: readonly T[], me: string, dueAt: (question: T) => number): T[] {
  const due = new Map(open.map((each) => [each.dialogue, dueAt(each)]));
  const dueOf = ({ dialogue }: T) => due.get(dialogue) ?? Infinity;
  return [...open].sort(
    (a, b) => rank(a, me) - rank(b, me) || sooner(dueOf(a), dueOf(b)) || a.opened - b.opened,
  );
}

/** What to show large: what is shown stays, as somebody reads it, until another one is this helper's turn before it. */
export function toShow<T extends Ordered>(queue: readonly T[], me: string, now: string | null): T | null {
  const [first] = queue;
  const stays = queue.find(({ dialogue }) => dialogue === now);
  if (first === undefined) return null;
  return stays !== undefined && rank(stays, me) <= rank(first, me) ? stays : first;
}

function rank(question: Ordered, me: string): number {
  const by = question.claimed_by;
  if (by !== null) return by === me ? 0 : 3;
  return isTurnOf(me, question) ? 1 : 2;
}

/** Clocks of runs are estimated: what is due within a second is due at once. */
function sooner(a: number, b: number): number {
  return a === b || Math.abs(a - b) < 1 ? 0 : a - b;
}

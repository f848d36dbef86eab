// Which question comes first for this helper.
import { computed, signal } from "@preact/signals";
import { helperName } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { isTurnOf } from "./turn";

/** What this helper is on, what they are asked, what others are asked, what others are on; each oldest first. */
export function inOrder(open: readonly Question[], me: string): Question[] {
  return [...open].sort((a, b) => rank(a, me) - rank(b, me) || a.opened - b.opened);
}

function rank(question: Question, me: string): number {
  const by = question.claimed_by;
  if (by !== null) return by === me ? 0 : 3;
  return isTurnOf(me, question) ? 1 : 2;
}

const chosen = signal<string | null>(null);

export const queue = computed(() => inOrder(questions.value, helperName.value));

/** The question that is shown large. */
export const shown = computed(
  () => queue.value.find((each) => each.dialogue === chosen.value) ?? queue.value[0] ?? null,
);

/** Show this one, whatever its turn; it stays until it is closed. */
export function choose(dialogue: string): void {
  chosen.value = dialogue;
}

/** Go back to the queue's own order. */
export function stopChoosing(): void {
  chosen.value = null;
}

// Which question comes first for this helper.
import { computed, signal } from "@preact/signals";
import { helperName } from "../state/preferences";
import { type Question, questions } from "../state/questions";

/** What this helper is on, then what nobody is on, then what others are on; each oldest first. */
export function inOrder(open: readonly Question[], me: string): Question[] {
  const turn = ({ claimed_by: by }: Question) => (by === me ? 0 : by === null ? 1 : 2);
  return [...open].sort((a, b) => turn(a) - turn(b) || a.opened - b.opened);
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

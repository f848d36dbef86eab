// Which question comes first for this helper.
import { computed, effect, signal } from "@preact/signals";
import { helperName } from "../state/preferences";
import { type Question, questions } from "../state/questions";
import { endOf } from "../state/run_clock";
import { runs } from "../state/service";
import { inOrder, toShow } from "./order";

const chosen = signal<string | null>(null);
const read = signal<string | null>(null);

export const queue = computed(() => inOrder(questions.value, helperName.value, dueAt));

/** The question that is shown large. */
export const shown = computed(
  () =>
    queue.value.find((each) => each.dialogue === chosen.value) ??
    toShow(queue.value, helperName.value, read.value),
);

effect(() => {
  read.value = shown.value?.dialogue ?? null;
});

/** Show this one, whatever its turn; it stays until it is closed. */
export function choose(dialogue: string): void {
  chosen.value = dialogue;
}

/** Go back to the queue's own order. */
export function stopChoosing(): void {
  chosen.value = null;
}

function dueAt({ run, prompt }: Question): number {
  const { status, speed } = runs.peek().get(run) ?? { status: "running", speed: 1 };
  const deadline = prompt?.deadline ?? null;
  return deadline === null || status === "paused" ? Infinity : endOf(run, deadline, speed);
}

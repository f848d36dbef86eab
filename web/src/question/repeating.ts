// Asking again: the question is said once more, by voice or by the screen reader.
import { signal } from "@preact/signals";
import type { Question } from "../state/questions";

/** What a screen reader is to read again; a new object each time. */
export const repeated = signal<{ text: string } | null>(null);

const voices = new Set<(question: Question) => boolean>();

/** Have repeated questions said by `voice` while it can; returns how to stop. */
export function onRepeat(voice: (question: Question) => boolean): () => void {
  voices.add(voice);
  return () => voices.delete(voice);
}

export function repeat(question: Question): void {
  for (const voice of voices) if (voice(question)) return;
  repeated.value = { text: question.prompt?.text ?? "" };
}

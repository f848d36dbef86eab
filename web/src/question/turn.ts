// Whose turn it is: a question is put to one helper after the other where the service has names of some.
import type { Question } from "../state/questions";

/** Who is asked now; null where anybody is. */
export function askedNow({ prompt }: Pick<Question, "prompt">): string | null {
  return prompt?.to ?? null;
}

export function isTurnOf(helper: string, question: Pick<Question, "prompt">): boolean {
  const asked = askedNow(question);
  return asked === null || asked === helper;
}

// Whether a question can be answered here and now.
import { may } from "../state/access";
import type { Question } from "../state/questions";
import { connection } from "../state/service";
import { given } from "./answering";
import type { Arming } from "./arming";

/** Whether it was answered, here or by somebody else. */
export function isAnswered({ prompt, awaiting }: Question): boolean {
  return prompt === null || given.value.has(prompt.prompt) || awaiting !== "answer";
}

export function takesAnswers(question: Question, { armed }: Arming): boolean {
  return armed && !isAnswered(question) && connection.value === "connected" && may("helper");
}

// Giving an answer, or choosing a way of help: at once, or, where it cannot be taken back otherwise,
// after three seconds in which it can be undone. Buttons, keys and speech all come through here.
import { effect, signal } from "@preact/signals";
import { may } from "../state/access";
import { tellEnding } from "../state/endings";
import { dialogueOf, type Question } from "../state/questions";
import { helperName } from "../state/preferences";
import { command } from "../state/service";
import { answerWhileLeaving, Refusal } from "../wire/rest";
import { t } from "../words/words";
import { said, whyNotDone } from "../words/said";

export type Answer = "yes" | "no";

/** As they stand on their buttons. */
export const WORDS = { yes: t("YES"), no: t("NO") } as const;

export const UNDO_MS = 3_000;

/** What somebody replies to a question: yes or no to it, or one of its ways, which stands for several. */
type Reply = { answer: Answer } | { way: string };

/** A reply that has not been sent yet. */
export interface Held {
  question: Question;
  prompt: string;
  reply: Reply;
  /** As it stands on its button. */
  said: string;
  effect: string;
}

export const held = signal<Held | null>(null);
/** The prompts that were answered here, also those whose answer is still on its way. */
export const given = signal<ReadonlySet<string>>(new Set());
/** What was wrong with the last answer, by prompt. */
export const mistakes = signal<ReadonlyMap<string, string>>(new Map());

let timer = 0;

/** Answer the open question of a dialogue. */
export function answer(question: Question, value: Answer): void {
  const option = question.prompt?.answers.find((each) => each.value === value);
  if (option !== undefined) give(question, { answer: value }, WORDS[value], option);
}

/** Choose one of the ways to answer the open question of a dialogue. */
export function choose(question: Question, way: string): void {
  const option = question.prompt?.ways.find((each) => each.way === way);
  if (option !== undefined) give(question, { way }, quoted(option.label), option);
}

/** What the service says, between quotation marks. */
export function quoted(text: string): string {
  return t("“{text}”", { text: said(text) });
}

/** Whether this is the reply that is being held. */
export function isHeld(prompt: string, words: string): boolean {
  return held.value?.prompt === prompt && held.value.said === words;
}

function give(question: Question, reply: Reply, words: string, option: { effect: string; final: boolean }): void {
  const { prompt } = question;
  if (!may("helper")) return;
  if (prompt === null || question.awaiting !== "answer" || given.value.has(prompt.prompt)) return;
  if (isHeld(prompt.prompt, words)) return;
  if (held.value?.prompt === prompt.prompt) undo();
  else sendHeld();
  note(prompt.prompt, null);
  const waiting = { question, prompt: prompt.prompt, reply, said: words, effect: option.effect };
  // Where the robot does not wait, help that comes three seconds later may come too late.
  if (!option.final || !question.interrupts) {
    void send(waiting);
    return;
  }
  held.value = waiting;
  timer = window.setTimeout(sendHeld, UNDO_MS);
}

/** Take back the reply that is being held. */
export function undo(): void {
  window.clearTimeout(timer);
  held.value = null;
}

/** Send the reply that is being held, without waiting longer. */
export function sendHeld(): void {
  const waiting = held.value;
  undo();
  if (waiting !== null) void send(waiting);
}

async function send({ question, prompt, reply, said: words }: Held): Promise<void> {
  const { dialogue } = question;
  given.value = new Set([...given.value, prompt]);
  try {
    await command(
      "way" in reply
        ? { type: "choose", dialogue, prompt, way: reply.way }
        : { type: "answer", dialogue, prompt, answer: reply.answer },
    );
  } catch (error) {
    given.value = new Set([...given.value].filter((each) => each !== prompt));
    const faster = error instanceof Refusal ? error.answeredBy : null;
    if (faster === null) {
      note(prompt, t("Your {reply} was not sent: {message}", { reply: words, message: whyNotDone(error) }));
    } else if (faster === helperName.value) {
      note(prompt, t("Your {reply} does not count: you have answered this already.", { reply: words }));
    } else {
      tellEnding(question, t("{faster} was faster; your {reply} does not count.", { faster, reply: words }));
    }
  }
}

function note(prompt: string, text: string | null): void {
  const next = new Map(mistakes.value);
  next.delete(prompt);
  if (text !== null) next.set(prompt, text);
  mistakes.value = next;
}

// Whoever else answers, and a robot that helps itself, make an answer that was held meaningless.
effect(() => {
  const waiting = held.value;
  if (waiting === null) return;
  const now = dialogueOf(waiting.question.dialogue);
  if (now?.prompt?.prompt === waiting.prompt && now.awaiting === "answer") return;
  const by = now?.answered_by ?? null;
  undo();
  const why = by === null ? t("the question was closed first") : t("{by} answered first", { by });
  tellEnding(waiting.question, t("Your {reply} was not sent: {why}.", { reply: waiting.said, why }));
});

window.addEventListener("pagehide", () => {
  const waiting = held.value;
  undo();
  if (waiting === null) return;
  answerWhileLeaving(waiting.question.dialogue, waiting.prompt, waiting.reply, helperName.value);
});

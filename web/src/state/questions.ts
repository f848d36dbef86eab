// The open dialogues across all runs, folded from the service's events.
import { computed, signal } from "@preact/signals";
import type {
  AwaitedHelp,
  DialogueView,
  Event,
  HelpNotSeen,
  HelpNotSeenYet,
  IssueRaised,
  Prompt,
  Resolution,
  UnseenHelpView,
} from "../wire/types";
import { closing, tellEnding, tellHowItEnded } from "./endings";
import { readRunClock } from "./run_clock";
import { t } from "../words/words";
import { learn } from "../words/said";

/** One open dialogue, with all that its card shows. */
export interface Question extends DialogueView {
  /** Of the journal: what came first is asked first. */
  opened: number;
}

/** A robot that moves slowly while somebody helps it: there is nothing to answer. */
export interface Together {
  dialogue: string;
  run: string;
  node: string;
  robot: string;
  issue: string;
  object: string | null;
  name: string;
  prompt: string;
  text: string;
  picture: string | null;
  /** Who has said that they help. */
  helper: string | null;
}

// How often a question may get more time is the service's rule; it corrects this with each extension.
const EXTENSIONS = 10;

const open = signal<ReadonlyMap<string, Question>>(new Map());
const raised = new Map<string, IssueRaised>();
const resolutions = new Map<string, Resolution>();

/** Every open dialogue in which people are asked, oldest first. */
export const dialogues = computed(() =>
  [...open.value.values()].filter((each) => !each.scripted).sort((a, b) => a.opened - b.opened),
);

/** Those that wait for an answer, oldest first. */
export const questions = computed(() => dialogues.value.filter(isAsked));

/** Those in which the robot watches for promised help. */
export const awaitingHelp = computed(() => dialogues.value.filter((each) => each.awaiting === "help"));

/** What is being placed by robot and helper together. */
export const together = signal<readonly Together[]>([]);

/** Whether its last word is a question: one that is open, or was answered this instant. */
function isAsked(question: Question): boolean {
  return question.prompt?.kind === "ask" && question.awaiting !== "help";
}

export function dialogueOf(id: string): Question | undefined {
  return open.value.get(id);
}

/** Take over the service's word on what is open; `runTimes` are the clocks of the runs. */
export function takeDialogues(views: readonly DialogueView[], runTimes: ReadonlyMap<string, number>): void {
  for (const [run, time] of runTimes) readRunClock(run, time);
  for (const { prompt } of views) if (prompt !== null) learn(prompt.wordings);
  const before = open.value;
  const next = new Map<string, Question>();
  for (const [index, view] of views.entries()) {
    const opened = before.get(view.dialogue)?.opened ?? index - views.length;
    next.set(view.dialogue, { ...view, opened });
  }
  open.value = next;
  for (const gone of before.values()) {
    if (!next.has(gone.dialogue) && !gone.scripted) void tellHowItEnded(gone);
  }
}

/** Fold one event into the dialogues. */
export function takeDialogueEvent(event: Event, me: string): void {
  readRunClock(event.run, event.time);
  switch (event.type) {
    case "issue_raised":
      raised.set(event.run + event.node, event);
      return;
    case "dialogue_opened":
      put(opened(event));
      return;
    case "node_done":
    case "node_left_out":
    case "node_reset":
      stopHelping((each) => each.run === event.run && each.node === event.node);
      return;
    case "run_finished":
    case "run_failed":
    case "run_aborted":
      stopHelping((each) => each.run === event.run);
      return;
  }
  if (!("dialogue" in event) || event.dialogue === null) return;
  const before = open.value.get(event.dialogue);
  if (before !== undefined) change(before, event, me);
}

function change(before: Question, event: Extract<Event, { dialogue: string | null }>, me: string): void {
  switch (event.type) {
    case "prompt":
      learn(event.wordings);
      put(prompted(before, event));
      return;
    case "clip_recorded":
      put({ ...before, clip: event.pictures });
      return;
    case "deadline_extended": {
      const { deadline, extensions_left } = event;
      if (before.prompt !== null) put({ ...before, prompt: { ...before.prompt, deadline, extensions_left } });
      return;
    }
    case "answered":
      if (event.helper !== me && !before.scripted) {
        tellEnding(before, t("{helper} answered {answer}.", { helper: event.helper, answer: event.answer === "yes" ? t("YES") : t("NO") }));
      }
      put({ ...before, awaiting: null, answered_by: event.helper });
      return;
    case "claimed":
      put({ ...before, claimed_by: event.helper, claimed_until: event.lease_until });
      return;
    case "released":
      if (before.claimed_by === event.helper) put({ ...before, claimed_by: null, claimed_until: null });
      return;
    case "help_awaited":
      put({
        ...before,
        awaiting: "help",
        help: awaited(event),
      });
      return;
    case "help_reported":
      if (before.help !== null) put({ ...before, help: { ...before.help, reported_by: event.helper } });
      return;
    case "help_not_seen_yet":
      if (before.help !== null) {
        put({ ...before, help: { ...before.help, reported_by: null }, unseen_help: unseen(event) ?? before.unseen_help });
      }
      return;
    case "help_not_seen":
      put({ ...before, awaiting: null, help: null, unseen_help: unseen(event) ?? before.unseen_help });
      return;
    case "help_verified":
    case "promise_taken_back":
      put({ ...before, awaiting: null, help: null });
      return;
    case "resolved":
      resolutions.set(event.dialogue, event.resolution);
      return;
    case "dialogue_closed":
      close(before, event.reason);
      return;
    default:
      return;
  }
}

function awaited({ help, helper, until, time, guess }: Extract<Event, { type: "help_awaited" }>): AwaitedHelp {
  return { help, helper, until, within_s: until - time, reported_by: null, at_a_word: guess === null };
}

/** What the camera showed of it; null where it showed nothing. */
function unseen({ time, picture, detection }: HelpNotSeen | HelpNotSeenYet): UnseenHelpView | null {
  return picture === null ? null : { time, picture, detection };
}

function prompted(before: Question, event: Prompt): Question {
  const known = before.prompt?.prompt === event.prompt ? before.prompt : null;
  const within_s = event.deadline === null ? null : event.deadline - event.time;
  return {
    ...before,
    awaiting: event.kind === "ask" ? "answer" : before.awaiting === "answer" ? null : before.awaiting,
    prompt: {
      ...event,
      within_s: known?.within_s ?? within_s,
      extensions_left: known?.extensions_left ?? (event.kind === "ask" ? EXTENSIONS : 0),
    },
  };
}

function opened(event: Extract<Event, { type: "dialogue_opened" }>): Question {
  const issue = raised.get(event.run + event.node) ?? null;
  return {
    dialogue: event.dialogue,
    run: event.run,
    status: "open",
    reason: null,
    issue: event.issue,
    object: event.object,
    robot: event.robot,
    node: event.node,
    name: event.name,
    scripted: event.scripted,
    interrupts: issue?.interrupts ?? true,
    prompt: null,
    awaiting: null,
    answered_by: null,
    claimed_by: null,
    claimed_until: null,
    picture: issue?.picture ?? null,
    clip: [],
    detection: issue?.detection ?? null,
    help: null,
    unseen_help: null,
    opened: event.seq,
  };
}

function close(question: Question, reason: Extract<Event, { type: "dialogue_closed" }>["reason"]): void {
  const statement = question.prompt?.kind === "say" ? question.prompt : null;
  if (resolutions.get(question.dialogue) === "collab_finish" && statement !== null && !question.scripted) {
    const { prompt, text } = statement;
    together.value = [...together.value, { ...question, prompt, text, helper: question.answered_by }];
  } else if (!question.scripted) {
    tellEnding(question, closing(reason, statement?.text ?? null, question.interrupts));
  }
  resolutions.delete(question.dialogue);
  const next = new Map(open.value);
  next.delete(question.dialogue);
  open.value = next;
}

/** No longer show what robot and helper do together. */
export function stopHelping(which: (each: Together) => boolean): void {
  if (together.value.some(which)) together.value = together.value.filter((each) => !which(each));
}

function put(question: Question): void {
  open.value = new Map(open.value).set(question.dialogue, question);
}

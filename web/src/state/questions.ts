// The open dialogues across all runs, and what became of those that closed while they were shown.
import { computed, signal } from "@preact/signals";
import type { DialogueView, Event, IssueRaised } from "../wire/types";

/** One open dialogue, with all that its card shows. */
export interface Question extends DialogueView {
  /** Of the journal: what came first is asked first. */
  opened: number;
  /** The run's time and this page's when the prompt came, to tell how long its deadline is off. */
  prompted: { runTime: number; at: number } | null;
  issueRaised: IssueRaised | null;
}

/** How a question ended that did not end by this helper's answer. */
export interface Ending {
  dialogue: string;
  text: string;
}

const open = signal<ReadonlyMap<string, Question>>(new Map());
const raised = new Map<string, IssueRaised>();

/** Those that wait for an answer, oldest first. */
export const questions = computed(() =>
  [...open.value.values()]
    .filter((each) => each.prompt?.kind === "ask" && each.awaiting === "answer")
    .sort((a, b) => a.opened - b.opened),
);

/** Every open dialogue, also those that say something or wait for promised help. */
export const dialogues = computed(() =>
  [...open.value.values()].sort((a, b) => a.opened - b.opened),
);

/** The last question that was answered by somebody else, withdrawn or given up. */
export const ending = signal<Ending | null>(null);

export function takeDialogues(views: readonly DialogueView[], runTimes: ReadonlyMap<string, number>): void {
  const at = performance.now();
  const next = new Map<string, Question>();
  for (const [index, view] of views.entries()) {
    const before = open.value.get(view.dialogue);
    next.set(view.dialogue, {
      ...view,
      opened: before?.opened ?? index - views.length,
      prompted: { runTime: runTimes.get(view.run) ?? 0, at },
      issueRaised: before?.issueRaised ?? null,
    });
  }
  open.value = next;
}

/** Fold one event into the questions. */
export function takeDialogueEvent(event: Event, me: string): void {
  if (event.type === "issue_raised") raised.set(event.run + event.node, event);
  if (!("dialogue" in event) || event.dialogue === null) return;
  const before = open.value.get(event.dialogue);
  if (event.type === "dialogue_opened") {
    put(opened(event));
    return;
  }
  if (before === undefined) return;
  switch (event.type) {
    case "prompt":
      put({
        ...before,
        prompt: { ...event, within_s: null, extensions_left: 0 },
        awaiting: event.kind === "ask" ? "answer" : before.awaiting,
        prompted: { runTime: event.time, at: performance.now() },
      });
      return;
    case "answered":
      if (event.helper !== me) tell(event.dialogue, `${event.helper} answered ${event.answer}.`);
      put({ ...before, awaiting: null, answered_by: event.helper });
      return;
    case "claimed":
      put({ ...before, claimed_by: event.helper, claimed_until: event.lease_until });
      return;
    case "released":
      put({ ...before, claimed_by: null, claimed_until: null });
      return;
    case "help_awaited":
      put({ ...before, awaiting: "help" });
      return;
    case "dialogue_closed":
      if (event.reason in ENDINGS && before.awaiting === "answer") {
        tell(event.dialogue, ENDINGS[event.reason] ?? "");
      }
      remove(event.dialogue);
      return;
    default:
      return;
  }
}

const ENDINGS: Readonly<Record<string, string>> = {
  withdrawn: "The robot saw that it was put right. Nothing to answer any more.",
  gave_up: "Nobody answered in time. The robot has given up this question.",
  aborted: "The question no longer matters: the robot does something else now.",
};

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
    prompt: null,
    awaiting: null,
    answered_by: null,
    claimed_by: null,
    claimed_until: null,
    picture: issue?.picture ?? null,
    clip: [],
    opened: event.seq,
    prompted: null,
    issueRaised: issue,
  };
}

function put(question: Question): void {
  open.value = new Map(open.value).set(question.dialogue, question);
}

function remove(dialogue: string): void {
  const next = new Map(open.value);
  next.delete(dialogue);
  open.value = next;
}

function tell(dialogue: string, text: string): void {
  ending.value = { dialogue, text };
}

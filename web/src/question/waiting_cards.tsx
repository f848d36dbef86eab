// While a robot watches for help that was promised, or is being helped: calm cards, nothing to answer.
import { helperName } from "../state/preferences";
import { type Question, stopHelping, type Together } from "../state/questions";
import type { Help } from "../wire/types";
import { AskingPlace } from "./asking_place";
import { TimeLeft, useSecondsUntil } from "./countdown";
import { robotName, spoken } from "./fault_words";
import { HelpCamera, seenBy } from "./help_camera";
import { PausedNode } from "./paused_node";
import { PromiseButtons } from "./promise_buttons";
import "./waiting_cards.css";

const PROMISES: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => `would place the ${part}`,
  put_back: (part) => `would put the ${part} back on the table`,
  hand_over: (part) => `would hand over the ${part}`,
  clear_way: () => "would clear the way",
  clear_view: () => "would clear the view of the head camera",
  tell_place: () => "know where it is",
  put_in: () => "would put something into its basket",
  take_out: () => "would take something out of its basket",
  charge: () => "would plug it in",
  send_person: () => "would tell who is to follow it to come",
};

const EXPECTED: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => `The robot watches for the ${part} at its place.`,
  put_back: (part) => `The robot watches for the ${part} on the table, within its reach.`,
  hand_over: (part) => `The robot watches for the ${part} between its fingers, and then grips it.`,
  clear_way: () => "The robot watches until nothing is in the way of its arm.",
  clear_view: () => "The robot watches until its head camera sees the table.",
  tell_place: () => "The robot looks whether what its laser sees agrees with that.",
  put_in: () => "The robot waits until it feels that in its basket.",
  take_out: () => "The robot waits until it feels that its basket is lighter.",
  charge: () => "The robot waits until it feels current.",
  send_person: () => "The robot waits until it sees them beside it.",
};

/** A base sees with its laser, and has no arm. */
function expected({ detection }: Question, help: Help, part: string): string {
  if (help === "clear_way" && detection?.camera === "laser") return "The robot watches until its way is free.";
  return EXPECTED[help](part);
}

interface AwaitedHelpProps {
  question: Question;
  /** Beside the run's own drawing of the tree, which shows the paused node already. */
  besideTree?: boolean;
}

export function AwaitedHelpCard({ question, besideTree = false }: AwaitedHelpProps) {
  const { help } = question;
  const part = spoken(question.object ?? question.name);
  return (
    <article class="waiting panel" aria-label={`${robotName(question.robot)} awaits help`}>
      <header class="waiting-head">
        <p class="question-about">
          <strong>{robotName(question.robot)}</strong>
          <a href={`/runs/${question.run}`}>Look at the run</a>
        </p>
        <Watching question={question} />
      </header>
      {question.prompt?.kind === "say" && (
        <p class="waiting-said" role="status">
          {question.prompt.text}
        </p>
      )}
      {help !== null && (
        <p>
          {help.helper === helperName.value ? "You said you" : `${help.helper} said they`}{" "}
          {PROMISES[help.help](part)}. {expected(question, help.help, part)}
        </p>
      )}
      <PromiseButtons question={question} />
      {help !== null && seenBy(question) !== null && <HelpCamera question={question} camera={seenBy(question)!} />}
      <AskingPlace question={question} />
      <p class="watching quiet small">It goes on by itself as soon as it sees that.</p>
      {!besideTree && <PausedNode run={question.run} node={question.node} name={question.name} />}
    </article>
  );
}

/** How much longer it watches for what was promised. */
function Watching({ question: { run, help } }: { question: Question }) {
  const left = useSecondsUntil(run, help?.until ?? null);
  if (left === null || help === null) return null;
  if (left > 0) return <TimeLeft left={left} within={help.within_s} what="It gives you" />;
  return <p class="quiet small">Its time for that is over: it looks once more.</p>;
}

export function TogetherCard({ together }: { together: Together }) {
  return (
    <article class="waiting panel" aria-label={`${robotName(together.robot)} needs a hand now`}>
      <p class="question-about">
        <strong>{robotName(together.robot)}</strong>
        <a href={`/runs/${together.run}`}>Look at the run</a>
      </p>
      <p class="waiting-said">{together.text}</p>
      <p class="quiet small">The robot has slowed down and goes on meanwhile. There is nothing to answer.</p>
      <button type="button" class="button" onClick={() => stopHelping((each) => each === together)}>
        Seen
      </button>
    </article>
  );
}

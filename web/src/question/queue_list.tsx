// The open questions at a glance, in the order in which they are asked.
import { helperName } from "../state/preferences";
import type { Question } from "../state/questions";
import { runs } from "../state/service";
import { clock, useSecondsLeft } from "./countdown";
import { faultInWords, robotName, spoken } from "./fault_words";
import { choose, queue } from "./queue";
import { askedNow } from "./turn";
import "./queue_list.css";

export function QueueList({ shown }: { shown: Question | null }) {
  return (
    <section aria-labelledby="queue-title" class="queue">
      <h2 id="queue-title">{queue.value.length} questions</h2>
      <ol>
        {queue.value.map((each) => (
          <li key={each.dialogue}>
            <button
              type="button"
              class="queue-item"
              aria-current={each.dialogue === shown?.dialogue ? "true" : undefined}
              onClick={() => choose(each.dialogue)}
            >
              <span class="queue-robot">
                {robotName(each.robot)}
                <Task run={each.run} />
                <Left question={each} />
              </span>
              <span>{faultInWords(each)}</span>
              <Taken by={each.claimed_by} asked={askedNow(each)} />
            </button>
          </li>
        ))}
      </ol>
    </section>
  );
}

function Task({ run }: { run: string }) {
  const tree = runs.value.get(run)?.tree;
  return tree === undefined ? null : <span class="queue-task">{spoken(tree)}</span>;
}

function Left({ question }: { question: Question }) {
  const left = useSecondsLeft(question);
  if (left === null) return null;
  return (
    <span class="queue-left">
      <span class="unseen">waits for </span>
      {clock(left)}
    </span>
  );
}

function Taken({ by, asked }: { by: string | null; asked: string | null }) {
  if (by === null) {
    if (asked === null) return null;
    return <span class="badge">{asked === helperName.value ? "You are asked" : `${asked} is asked`}</span>;
  }
  return <span class="badge">{by === helperName.value ? "You are on it" : `${by} is on it`}</span>;
}

// The open questions at a glance, in the order in which they are asked.
import { helperName } from "../state/preferences";
import type { Question } from "../state/questions";
import { faultInWords, robotName } from "./fault_words";
import { choose, queue } from "./queue";
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
              <span class="queue-robot">{robotName(each.robot)}</span>
              <span>{faultInWords(each)}</span>
              <Taken by={each.claimed_by} />
            </button>
          </li>
        ))}
      </ol>
    </section>
  );
}

function Taken({ by }: { by: string | null }) {
  if (by === null) return null;
  return <span class="badge">{by === helperName.value ? "You are on it" : `${by} is on it`}</span>;
}

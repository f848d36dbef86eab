// What the robots ask: the oldest open question large, the others in a queue.
import { questions } from "../state/questions";
import { QuestionCard } from "./question_card";

export function QuestionsView() {
  const [first, ...others] = questions.value;
  return (
    <section class="page">
      <h1 class="unseen">Questions</h1>
      {first === undefined ? (
        <p class="quiet">No robot asks anything. This page tells you when one does.</p>
      ) : (
        <QuestionCard key={first.dialogue} question={first} />
      )}
      {others.length > 0 && (
        <ol aria-label="More questions">
          {others.map((each) => (
            <li key={each.dialogue} class="panel">
              {each.robot}: {each.prompt?.text}
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}

// One question with what went wrong, and the two answers with what each will do.
import { useState } from "preact/hooks";
import type { Question } from "../state/questions";
import { command } from "../state/service";
import { picturePath, Refusal } from "../wire/rest";
import "./question_card.css";

export function QuestionCard({ question }: { question: Question }) {
  const [note, setNote] = useState("");
  const { prompt } = question;
  if (prompt === null) return null;
  const answer = async (value: "yes" | "no") => {
    try {
      await command({ type: "answer", dialogue: question.dialogue, prompt: prompt.prompt, answer: value });
    } catch (error) {
      const faster = error instanceof Refusal ? error.answeredBy : null;
      setNote(faster === null ? String((error as Error).message) : `${faster} was faster.`);
    }
  };
  return (
    <article class="question panel" aria-labelledby="question-text">
      <p class="question-about">
        {question.robot} · {question.issue} · {question.name}
      </p>
      <h2 id="question-text" class="question-text">
        {prompt.text}
      </h2>
      {question.picture !== null && (
        <img class="question-picture" src={picturePath(question.picture)} alt="What the robot saw at the fault" />
      )}
      <div class="answers">
        {prompt.answers.map(({ value, effect }) => (
          <button key={value} type="button" class={`answer ${value}`} onClick={() => void answer(value)}>
            <span class="answer-word">{value === "yes" ? "YES" : "NO"}</span>
            <span class="answer-effect">{effect}</span>
          </button>
        ))}
      </div>
      <p role="status">{note}</p>
    </article>
  );
}

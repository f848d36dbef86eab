// Tells a screen reader of each new question, once, whatever view is open.
import { repeated } from "./repeating";
import { faultInWords, robotName } from "./fault_words";
import { newest } from "./arrivals";

export function Announcer() {
  const question = newest.value;
  return (
    <>
      <p class="unseen" role="alert">
        {question !== null && `${robotName(question.robot)} asks: ${question.prompt?.text ?? faultInWords(question)}`}
      </p>
      <p class="unseen" role="status" key={repeated.value?.text}>
        {repeated.value?.text}
      </p>
    </>
  );
}

// Tells a screen reader of each new question, once, whatever view is open.
import { repeated } from "./repeating";
import { faultInWords, robotName } from "./fault_words";
import { newest } from "./arrivals";
import { t } from "../words/words";
import { said } from "../words/said";
import { Told } from "../words/told";

export function Announcer() {
  const question = newest.value;
  return (
    <>
      <p class="unseen" role="alert">
        {question !== null &&
          t("{robot} asks: {question}", {
            robot: robotName(question.robot),
            question: question.prompt === null ? faultInWords(question) : said(question.prompt.text),
          })}
      </p>
      <p class="unseen" role="status" key={repeated.value?.text}>
        {repeated.value !== null && <Told text={repeated.value.text} />}
      </p>
    </>
  );
}

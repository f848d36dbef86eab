// The open question of one run, for the side column of the run's own view.
import { awaitingHelp, together } from "../state/questions";
import { queue } from "./queue";
import { Endings } from "./endings_list";
import { QuestionCard } from "./question_card";
import { AwaitedHelpCard, TogetherCard } from "./waiting_cards";
import { t } from "../words/words";

export function RunQuestion({ run }: { run: string }) {
  const question = queue.value.find((each) => each.run === run);
  return (
    <section class="run-question" aria-label={t("What this run asks")}>
      <Endings run={run} />
      {question !== undefined && <QuestionCard key={question.dialogue} question={question} besideTree />}
      {awaitingHelp.value
        .filter((each) => each.run === run)
        .map((each) => (
          <AwaitedHelpCard key={each.dialogue} question={each} besideTree />
        ))}
      {together.value
        .filter((each) => each.run === run)
        .map((each) => (
          <TogetherCard key={each.dialogue} together={each} />
        ))}
    </section>
  );
}

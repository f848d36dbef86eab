// What the robots of a fleet ask: one question as a card with its place, the others in a list.
import { useState } from "preact/hooks";
import { faultInWords, robotName } from "../question/fault_words";
import { QuestionCard } from "../question/question_card";
import { queue } from "../question/queue";
import { AwaitedHelpCard } from "../question/waiting_cards";
import { awaitingHelp } from "../state/questions";
import type { Asking } from "./fleet_robots";
import { t } from "../words/words";

/** Which robots of a fleet ask, or are being helped. */
export function askingOf(robots: readonly string[]): Asking {
  const mine = (robot: string) => robots.includes(robot);
  return new Map([
    ...awaitingHelp.value.filter(({ robot }) => mine(robot)).map(({ robot }) => [robot, "helped"] as const),
    ...queue.value.filter(({ robot }) => mine(robot)).map(({ robot }) => [robot, "asking"] as const),
  ]);
}

export function FleetQuestions({ robots }: { robots: readonly string[] }) {
  const [chosen, setChosen] = useState<string | null>(null);
  const asked = queue.value.filter(({ robot }) => robots.includes(robot));
  const helped = awaitingHelp.value.filter(({ robot }) => robots.includes(robot));
  // One at a time: the answer keys belong to the card that is shown.
  const shown = asked.find(({ dialogue }) => dialogue === chosen) ?? asked[0];
  if (shown === undefined && helped.length === 0) return null;
  return (
    <section class="fleet-questions" aria-label={t("What its robots ask")}>
      {shown !== undefined && <QuestionCard key={shown.dialogue} question={shown} besideTree />}
      {asked.length > 1 && (
        <ul class="panel fleet-asked" aria-label={t("Also asked")}>
          {asked
            .filter((each) => each !== shown)
            .map((each) => (
              <li key={each.dialogue}>
                <button type="button" class="bare" onClick={() => setChosen(each.dialogue)}>
                  <b>{robotName(each.robot)}</b> {faultInWords(each)}
                </button>
              </li>
            ))}
        </ul>
      )}
      {helped.map((each) => (
        <AwaitedHelpCard key={each.dialogue} question={each} besideTree />
      ))}
    </section>
  );
}

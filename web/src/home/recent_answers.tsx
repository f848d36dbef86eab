// What people answered last, and what came of it.
import { useEffect, useState } from "preact/hooks";
import { momentOf, outcomeOf } from "../issues/issue_words";
import { faultInWords } from "../question/fault_words";
import { ago } from "../run/run_words";
import { onEvent, onSnapshot } from "../state/service";
import { useNow } from "../state/use_now";
import * as rest from "../wire/rest";
import type { DialogueView, Event, IssueSummary } from "../wire/types";
import { t } from "../words/words";
import { HomeList } from "./home_list";

const LOOKED_AT = 12;
const CHANGES: ReadonlySet<Event["type"]> = new Set(["answered", "dialogue_closed"]);

interface Answered {
  readonly issue: IssueSummary;
  readonly dialogue: DialogueView;
}

export function RecentAnswers() {
  const answers = useRecentAnswers();
  const now = useNow();
  if (answers.length === 0) return null;
  return (
    <HomeList
      id="home-answers"
      title={t("Answered last")}
      href="/issues"
      all={t("All issues")}
      items={answers.map(({ issue, dialogue }) => (
        <li key={dialogue.dialogue}>
          <a href={momentOf(issue)}>{faultInWords(dialogue)}</a>
          <span class="home-state">{outcomeOf(issue)}</span>
          <span class="small quiet">{t("{helper}, {ago}", { helper: dialogue.answered_by ?? "", ago: ago(Date.parse(issue.raised), now) })}</span>
        </li>
      ))}
    />
  );
}

function useRecentAnswers(): readonly Answered[] {
  const [answers, setAnswers] = useState<readonly Answered[]>([]);
  useEffect(() => {
    let newest = 0;
    const read = () => {
      const mine = ++newest;
      recentAnswers().then((found) => mine === newest && setAnswers(found), () => undefined);
    };
    const stop = [onSnapshot(read), onEvent((event) => CHANGES.has(event.type) && read())];
    read();
    return () => {
      newest = -1;
      stop.forEach((each) => each());
    };
  }, []);
  return answers;
}

/** Of the newest issues those that somebody answered; what scripts answer is nobody's. */
async function recentAnswers(): Promise<readonly Answered[]> {
  const issues = await rest.issues("", null, LOOKED_AT);
  const found = issues.flatMap((issue) => (issue.dialogue === null ? [] : [answerTo(issue, issue.dialogue)]));
  return (await Promise.all(found)).filter(({ dialogue }) => dialogue.answered_by !== null && !dialogue.scripted);
}

async function answerTo(issue: IssueSummary, dialogue: string): Promise<Answered> {
  return { issue, dialogue: await rest.dialogue(dialogue) };
}

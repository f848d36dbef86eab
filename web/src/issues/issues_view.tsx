// What robots noticed, newest first: found by its part, robot or task tree, and opened at its moment.
import { useState } from "preact/hooks";
import { KNOWN_ISSUES } from "../question/fault_words";
import { isAnything, queryOf } from "../run/search";
import { SearchFields } from "../run/search_fields";
import { ago, clock, moment } from "../run/run_words";
import { useSettled } from "../run/use_settled";
import { useNow } from "../state/use_now";
import { plain, withoutRun } from "../tree/words";
import type { IssueSummary } from "../wire/types";
import { momentOf, outcomeOf } from "./issue_words";
import { useIssuesPage } from "./issues_page";
import { pages, search, searchIssues } from "./issues_search";
import { issueKind, issueMeant } from "../words/issue_kinds";
import { t } from "../words/words";
import "./issues.css";

export function IssuesView() {
  const query = useSettled(queryOf({ ...search.value, text: issueMeant(search.value.text, KNOWN_ISSUES) }).toString());
  const { issues, more, failure } = useIssuesPage(query, pages.value.at(-1) ?? null);
  const now = useNow();
  const none = issues !== null && issues.length === 0;
  return (
    <section class="page">
      <div class="page-head">
        <h1>{t("Issues")}</h1>
        <a class="button" href="/statistics">{t("Statistics")}</a>
      </div>
      <SearchFields
        search={search.value}
        hint={t("Part, place, robot, kind of issue, task tree")}
        onSearch={searchIssues}
      />
      <p class="mistake" role="alert">
        {failure}
      </p>
      {issues === null && failure === "" && <p class="quiet">{t("Loading …")}</p>}
      {none && (
        <p class="panel empty quiet">
          {isAnything(search.value) ? t("No robot has noticed anything wrong yet.") : t("No issue is like this.")}
        </p>
      )}
      {issues !== null && !none && (
        <ol class="issues" aria-label={t("Issues, newest first")}>
          {issues.map((issue) => (
            <Row key={issue.seq} issue={issue} now={now} />
          ))}
        </ol>
      )}
      <Paging last={issues?.at(-1)?.seq ?? null} more={more} />
    </section>
  );
}

function Row({ issue, now }: { issue: IssueSummary; now: number }) {
  const raised = Date.parse(issue.raised);
  return (
    <li>
      <a class="issue" href={momentOf(issue)}>
        <Picture picture={issue.picture} />
        <span class="issue-what">
          <strong>{issueKind(issue.issue)}</strong>
          <span>{plain(issue.object ?? issue.name)}</span>
        </span>
        <span class="issue-where">
          <span>{plain(issue.tree)}</span>
          <span class="small quiet">{t("{robot} · {world} · at {time}", { robot: withoutRun(issue.robot), world: issue.world, time: clock(issue.time) })}</span>
        </span>
        <span class="issue-outcome">{outcomeOf(issue)}</span>
        <span class="issue-raised">
          <span>{ago(raised, now)}</span>
          <time class="small quiet" datetime={issue.raised}>
            {moment(raised)}
          </time>
        </span>
      </a>
    </li>
  );
}

/** What the robot saw then, if it is still kept. */
function Picture({ picture }: { picture: string | null }) {
  const [gone, setGone] = useState(false);
  if (picture === null || gone) return <span class="issue-picture" />;
  return (
    <img class="issue-picture" src={`/api/pictures/${picture}`} alt="" loading="lazy" onError={() => setGone(true)} />
  );
}

function Paging({ last, more }: { last: number | null; more: boolean }) {
  const page = pages.value.length;
  if (page === 1 && !more) return null;
  return (
    <nav class="paging" aria-label={t("Pages of issues")}>
      <button class="button" type="button" disabled={page === 1} onClick={() => (pages.value = pages.value.slice(0, -1))}>{t("Newer")}</button>
      <span class="quiet">{t("Page {page}", { page })}</span>
      <button class="button" type="button" disabled={!more} onClick={() => (pages.value = [...pages.value, last])}>{t("Older")}</button>
    </nav>
  );
}

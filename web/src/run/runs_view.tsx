// The list of runs, newest first, by state.
import { signal } from "@preact/signals";
import { may } from "../state/access";
import { robotName } from "../question/fault_words";
import { questions } from "../state/questions";
import { useNow } from "../state/use_now";
import type { RunStatus, RunSummary } from "../wire/types";
import { useRunsPage } from "./runs_page";
import { ago, moment, outcome, STATUS_SIGNS, STATUS_WORDS } from "./run_words";
import { ANYTHING, isAnything, queryOf } from "./search";
import { SearchFields } from "./search_fields";
import { useSettled } from "./use_settled";
import { t } from "../words/words";
import "./runs.css";

interface Filter {
  name: string;
  statuses: readonly RunStatus[];
}

const ALL: Filter = { name: t("All"), statuses: [] };
const FILTERS: readonly Filter[] = [
  ALL,
  { name: t("Going on"), statuses: ["running", "paused"] },
  { name: t("Finished"), statuses: ["finished"] },
  { name: t("Failed"), statuses: ["failed"] },
  { name: t("Aborted"), statuses: ["aborted"] },
  { name: t("Unreadable"), statuses: ["unreadable"] },
];

/** Chosen once, kept while one looks at a run and comes back. */
const filter = signal(ALL);
const page = signal(0);
const search = signal(ANYTHING);

export function RunsView() {
  const query = useSettled(queryOf(search.value).toString());
  const { runs, more, failure } = useRunsPage(filter.value.statuses, page.value, query);
  const now = useNow();
  const none = runs !== null && runs.length === 0;
  const isAll = filter.value === ALL && page.value === 0 && isAnything(search.value);
  return (
    <section class="page">
      <div class="page-head">
        <h1>{t("Runs")}</h1>
        {may("operator") && (
          <a class="button primary" href="/start">
            {t("Start a run")}
          </a>
        )}
      </div>
      <SearchFields
        search={search.value}
        hint={t("Task tree, robot, world, scenario")}
        onSearch={(wanted) => {
          search.value = wanted;
          page.value = 0;
        }}
      />
      <Filters />
      <p class="mistake" role="alert">
        {failure}
      </p>
      {runs === null && failure === "" && <p class="quiet">{t("Loading …")}</p>}
      {none && (isAll ? <NoRunsYet /> : <NoneLikeThis />)}
      {runs !== null && !none && (
        <ol class="runs" aria-label={t("Runs, newest first")}>
          {runs.map((run) => (
            <Row key={run.id} run={run} now={now} />
          ))}
        </ol>
      )}
      {(more || page.value > 0) && <Paging more={more} />}
    </section>
  );
}

function Filters() {
  return (
    <div class="filters" role="group" aria-label={t("Show runs by state")}>
      {FILTERS.map((each) => (
        <button
          key={each.name}
          class="button filter"
          type="button"
          aria-pressed={filter.value === each}
          onClick={() => {
            filter.value = each;
            page.value = 0;
          }}
        >
          {each.name}
        </button>
      ))}
    </div>
  );
}

function Row({ run, now }: { run: RunSummary; now: number }) {
  const started = Date.parse(run.started);
  const asks = questions.value.some((each) => each.run === run.id);
  return (
    <li>
      <a class="run" href={`/runs/${run.id}`}>
        <span class="run-state">
          <span class={`badge ${run.status}`}>
            <span aria-hidden="true">{STATUS_SIGNS[run.status]}</span>
            {STATUS_WORDS[run.status]}
          </span>
        </span>
        <span class="run-tree">
          <strong>{run.tree}</strong>
          <span class="small quiet">
            {run.world}
            {run.scenario !== null && ` · ${run.scenario}`}
            {run.robots.length > 0 && ` · ${robotsInWords(run.robots)}`}
          </span>
        </span>
        <span class="run-outcome">
          {asks ? <strong class="run-asks">{t("Asks a question")}</strong> : outcome(run)}
        </span>
        <span class="run-started">
          <span>{ago(started, now)}</span>
          <time class="small quiet" datetime={run.started}>
            {moment(started)}
          </time>
        </span>
      </a>
    </li>
  );
}

const NAMED_AT_MOST = 3;

/** Of what is done for people each run has one robot, and nothing else tells them apart. */
function robotsInWords(robots: readonly string[]): string {
  const names = robots.slice(0, NAMED_AT_MOST).map(robotName).join(", ");
  const more = robots.length - NAMED_AT_MOST;
  return more > 0 ? t("{names} and {more} more", { names, more }) : names;
}

function NoRunsYet() {
  return (
    <div class="panel empty">
      <h2>{t("No runs yet")}</h2>
      <p class="quiet">{t("A run is one execution of a task tree by a robot, in a simulated world or a real one.")}</p>
      <a class="button" href="/start">
        {t("Start the first one")}
      </a>
    </div>
  );
}

function NoneLikeThis() {
  return <p class="panel empty quiet">{t("No runs to show here.")}</p>;
}

function Paging({ more }: { more: boolean }) {
  return (
    <nav class="paging" aria-label={t("Pages of runs")}>
      <button class="button" type="button" disabled={page.value === 0} onClick={() => page.value--}>
        {t("Newer")}
      </button>
      <span class="quiet">{t("Page {page}", { page: page.value + 1 })}</span>
      <button class="button" type="button" disabled={!more} onClick={() => page.value++}>
        {t("Older")}
      </button>
    </nav>
  );
}

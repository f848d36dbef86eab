// How often what goes wrong, how it ends and how long people take to answer, over the runs of some days.
import { signal } from "@preact/signals";
import { useMemo, useRef } from "preact/hooks";
import { searchIssues } from "../issues/issues_search";
import { ANYTHING, queryOf, type Search } from "../run/search";
import { useSettled } from "../run/use_settled";
import { plain } from "../tree/words";
import type { GroupedStatistics, Statistics } from "../wire/types";
import { answersOf, faultsOf, type Figure, outcomesOf, rateOf, runsOf } from "./statistics_words";
import { useStatistics } from "./use_statistics";
import "../run/search_fields.css";
import { issueKind } from "../words/issue_kinds";
import { t } from "../words/words";
import { locale } from "../words/language";
import "./statistics.css";

interface Chosen {
  readonly days: Search;
  readonly tree: string;
  readonly robot: string;
}

const ALL: Chosen = { days: ANYTHING, tree: "", robot: "" };

/** Chosen once, kept while one looks at an issue and comes back. */
const chosen = signal(ALL);

export function StatisticsView() {
  const { found, failure } = useStatistics(useSettled(queryOfChosen(chosen.value)));
  return (
    <section class="page">
      <div class="page-head">
        <h1>{t("Statistics")}</h1>
        <a class="button" href="/issues">
          {t("Issues")}
        </a>
      </div>
      <Choice found={found} />
      <p class="mistake" role="alert">
        {failure}
      </p>
      {found === null && failure === "" && <p class="quiet">{t("Loading …")}</p>}
      {found !== null && <Told found={found} />}
    </section>
  );
}

function queryOfChosen({ days, tree, robot }: Chosen): string {
  const query = queryOf(days);
  if (tree !== "") query.set("tree", tree);
  if (robot !== "") query.set("robot", robot);
  return query.toString();
}

function Choice({ found }: { found: Statistics | null }) {
  const trees = useKnown(found?.by_tree ?? null);
  const robots = useKnown(found?.by_robot ?? null);
  const { days, tree, robot } = chosen.value;
  const set = (change: Partial<Chosen>) => {
    chosen.value = { ...chosen.value, ...change };
  };
  return (
    <search class="search">
      <div class="field">
        <label for="statistics-from">{t("Runs from")}</label>
        <input
          id="statistics-from"
          type="date"
          max={days.to}
          value={days.from}
          onInput={(event) => set({ days: { ...days, from: event.currentTarget.value } })}
        />
      </div>
      <div class="field">
        <label for="statistics-to">{t("To")}</label>
        <input
          id="statistics-to"
          type="date"
          min={days.from}
          value={days.to}
          onInput={(event) => set({ days: { ...days, to: event.currentTarget.value } })}
        />
      </div>
      <Names id="statistics-tree" label={t("Task tree")} names={trees} value={tree} onChoose={(name) => set({ tree: name })} />
      <Names id="statistics-robot" label={t("Robot")} names={robots} value={robot} onChoose={(name) => set({ robot: name })} />
      <button class="button" type="button" disabled={queryOfChosen(chosen.value) === ""} onClick={() => set(ALL)}>
        {t("Clear")}
      </button>
    </search>
  );
}

/** The names that were told once: what is chosen leaves only one of them. */
function useKnown(grouped: GroupedStatistics | null): readonly string[] {
  const known = useRef(new Set<string>());
  return useMemo(() => {
    for (const { name } of grouped?.groups ?? []) known.current.add(name);
    return [...known.current].sort();
  }, [grouped]);
}

interface NamesProps {
  id: string;
  label: string;
  names: readonly string[];
  value: string;
  onChoose: (name: string) => void;
}

function Names({ id, label, names, value, onChoose }: NamesProps) {
  const all = value === "" || names.includes(value) ? names : [value, ...names];
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <select id={id} value={value} onChange={(event) => onChoose(event.currentTarget.value)}>
        <option value="">{t("All")}</option>
        {all.map((name) => (
          <option key={name} value={name}>
            {plain(name)}
          </option>
        ))}
      </select>
    </div>
  );
}

function Told({ found }: { found: Statistics }) {
  const { runs, total } = found;
  if (runs.total === 0) return <p class="panel empty quiet">{t("There is no run like this.")}</p>;
  return (
    <>
      <dl class="panel figures">
        <Tile name={t("Runs")} figure={runsOf(runs)} />
        <Tile name={t("Faults per 1,000 picks")} figure={rateOf(total)} />
        <Tile name={t("Time to answer, median")} figure={answersOf(total.answers)} />
        <Tile name={t("Outcomes")} figure={{ value: faultsOf(total.faults), of: outcomesOf(total.outcomes) }} />
      </dl>
      <p class="quiet small">
        {t(
          "A fault is an issue that a robot raised. A pick is a gripper that closed to take something. An answer is a person's, from when its question was put first.",
        )}
      </p>
      <Groups title={t("By kind of fault")} kind="fault" name={t("Kind")} grouped={found.by_issue} allPicks />
      <Groups title={t("By part")} kind="part" name={t("Part")} grouped={found.by_part} />
      <Groups title={t("By robot")} kind="robot" name={t("Robot")} grouped={found.by_robot} />
      <Groups title={t("By task tree")} kind="task-tree" name={t("Task tree")} grouped={found.by_tree} />
    </>
  );
}

function Tile({ name, figure }: { name: string; figure: Figure }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>
        <strong>{figure.value}</strong>
        <span class="small quiet">{figure.of}</span>
      </dd>
    </div>
  );
}

interface GroupsProps {
  title: string;
  /** For the ids of the page. */
  kind: string;
  /** What the groups are. */
  name: string;
  grouped: GroupedStatistics;
  /** Whether the picks are those of all groups together. */
  allPicks?: boolean;
}

function Groups({ title, kind, name, grouped, allPicks = false }: GroupsProps) {
  const id = `statistics-${kind}-groups`;
  return (
    <section class="panel statistics">
      <h2 id={id}>{title}</h2>
      {grouped.groups.length === 0 ? (
        <p class="quiet">{allPicks ? t("No faults.") : t("No faults and no picks.")}</p>
      ) : (
        <div class="statistics-table" role="region" aria-labelledby={id} tabIndex={0}>
          <table>
            <thead>
              <tr>
                <th scope="col">{name}</th>
                <th scope="col">{t("Faults")}</th>
                <th scope="col">{allPicks ? t("All picks") : t("Picks")}</th>
                <th scope="col">{t("Faults per 1,000 picks")}</th>
                <th scope="col">{t("Time to answer")}</th>
                <th scope="col">{t("Outcomes")}</th>
              </tr>
            </thead>
            <tbody>
              {grouped.groups.map((group) => (
                <Row key={group.name} group={group} called={kind === "fault" ? issueKind(group.name) : plain(group.name)} />
              ))}
            </tbody>
          </table>
        </div>
      )}
      {grouped.left_out > 0 && (
        <p class="quiet small">
          {t("and {count} more, with fewer faults", { count: grouped.left_out.toLocaleString(locale) })}
        </p>
      )}
    </section>
  );
}

function Row({ group, called }: { group: GroupedStatistics["groups"][number]; called: string }) {
  const answers = answersOf(group.answers);
  const { from, to } = chosen.value.days;
  return (
    <tr>
      <th scope="row">
        <a href="/issues" onClick={() => searchIssues({ text: plain(group.name), from, to })}>
          {called}
        </a>
      </th>
      <td>{group.faults.toLocaleString(locale)}</td>
      <td>{group.picks === 0 ? t("none") : group.picks.toLocaleString(locale)}</td>
      <td>{rateOf(group).value}</td>
      <td>
        {answers.value} <span class="small quiet">{answers.of}</span>
      </td>
      <td class="words">{outcomesOf(group.outcomes)}</td>
    </tr>
  );
}

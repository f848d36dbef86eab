// The chart of a fleet: a row a robot over the site's clock, and why its plan changed.
import { useComputed } from "@preact/signals";
import { useMemo, useState } from "preact/hooks";
import type { Moment } from "../run/moment";
import { Lanes } from "../run/timeline/lanes_drawing";
import type { TimelineItem } from "../run/timeline/lanes";
import { middleOf, type Scale, type Span, within, zoomed } from "../run/timeline/span";
import { sentence } from "../run/run_words";
import type { FleetRobot } from "../wire/types";
import { ChartTable } from "./chart_table";
import { changeInWords, chartRows, type Transfer } from "./chart_rows";
import { eventsUntil, type FleetEvent } from "./fleet_past";
import { wholeClock } from "./fleet_words";
import "../run/timeline/timeline.css";
import { t } from "../words/words";

const FIRST_LENGTH_S = 600;
const SHORTEST_S = 30;
/** What is shown of the time to come, where the chart follows the clock. */
const AHEAD = 0.35;
const STEP_S = 1;
const LABEL = t("Robots and changes of their plan; the arrow keys go from one thing to the next, Enter shows what it was");

interface FleetChartProps {
  events: readonly FleetEvent[];
  robots: readonly FleetRobot[];
  moment: Moment;
}

export function FleetChart({ events, robots, moment }: FleetChartProps) {
  const time = useComputed(() => Math.floor(moment.time.value / STEP_S) * STEP_S).value;
  const newest = moment.newest.value;
  const [length, setLength] = useState(FIRST_LENGTH_S);
  const [own, setOwn] = useState<Span | null>(null);
  const [asTable, setAsTable] = useState(false);
  const [chosen, setChosen] = useState<TimelineItem | null>(null);
  const names = robots.map(({ robot }) => robot);
  const rows = useMemo(
    () => chartRows(names, newest ? events : eventsUntil(events, time), time, newest ? robots : null),
    [names.join(" "), events, time, newest, newest ? robots : null],
  );
  const ends = rows.lanes.flatMap(({ items }) => items.map((item) => item.end));
  const whole: Span = { from: 0, to: Math.max(time + AHEAD * length, ...ends) };
  const span = own ?? within(time - (1 - AHEAD) * length, Math.min(length, whole.to), whole);
  const zoom = (factor: number, around = middleOf(span, time)) => {
    const next = zoomed(span, factor, around, whole) ?? whole;
    if (next.to - next.from < SHORTEST_S) return;
    setLength(next.to - next.from);
    if (own !== null) setOwn(next);
  };
  const item = chosen === null ? null : (rows.lanes.flatMap((lane) => lane.items).find(({ seq }) => seq === chosen.seq) ?? null);
  return (
    <section class="panel timeline fleet-chart" aria-labelledby="fleet-chart-title">
      <div class="panel-bar">
        <h2 id="fleet-chart-title">{t("Plan")}</h2>
        <button type="button" class="small-button" aria-pressed={asTable} onClick={() => setAsTable(!asTable)}>{t("As a table")}</button>
        <div class="tree-zoom" role="group" aria-label={t("Span of the plan")}>
          <button type="button" class="small-button" aria-label={t("Longer span")} onClick={() => zoom(2)}>
            −
          </button>
          <button type="button" class="small-button" aria-label={t("Follow the moment")} aria-pressed={own === null} onClick={() => setOwn(null)}>{t("Follow")}</button>
          <button type="button" class="small-button" aria-label={t("Shorter span")} disabled={length / 2 < SHORTEST_S} onClick={() => zoom(0.5)}>
            +
          </button>
        </div>
      </div>
      {!newest && (
        <p class="small quiet">{t("What was planned at that moment is not kept: only what was done, and why the plan changed.")}</p>
      )}
      {asTable ? (
        <ChartTable rows={rows} names={names} />
      ) : (
        <Lanes
          label={LABEL}
          lanes={rows.lanes}
          moment={moment}
          span={span}
          whole={whole}
          setSpan={setOwn}
          zoom={zoom}
          onChoose={setChosen}
          overlay={(scale, middle, height) => (
            <>
              <Now scale={scale} at={moment.end.value} height={height} />
              <Links transfers={rows.transfers} scale={scale} middle={middle} />
            </>
          )}
        />
      )}
      <Legend />
      <div class="chart-chosen" role="status">
        {item !== null && <Chosen item={item} events={events} moment={moment} />}
      </div>
    </section>
  );
}

function Chosen({ item, events, moment }: { item: TimelineItem; events: readonly FleetEvent[]; moment: Moment }) {
  const event = events.find(({ seq }) => seq === item.seq);
  const change = event === undefined ? [] : changeInWords(event);
  const words = change.length > 0 ? change : [sentence(item.title)];
  return (
    <>
      <p>
        <b>{wholeClock(item.start)}</b>
        {item.end > item.start && <>–{wholeClock(item.end)}</>} {words.join(" ")}
      </p>
      {event !== undefined && (
        <button type="button" class="small-button" onClick={() => moment.goTo(event.at_s, event.seq)}>{t("Look at this moment")}</button>
      )}
    </>
  );
}

function Now({ scale, at, height }: { scale: Scale; at: number; height: number }) {
  if (at < scale.from || at > scale.to) return null;
  return <line class="chart-now" x1={scale.x(at)} x2={scale.x(at)} y1={20} y2={height} aria-hidden="true" />;
}

function Links({ transfers, scale, middle }: { transfers: readonly Transfer[]; scale: Scale; middle(lane: number): number }) {
  return (
    <g aria-hidden="true">
      {transfers
        .filter(({ given_s, taken_s }) => taken_s >= scale.from && given_s <= scale.to)
        .map(({ request, from, to, given_s, taken_s, planned }) => {
          const [x0, x1] = [given_s, taken_s].map((time) => Math.min(Math.max(scale.x(time), scale.left), scale.left + scale.width));
          return (
            <g key={`${request} ${given_s}`} class={`chart-link ${planned ? "planned" : ""}`} data-request={request}>
              <path d={`M${x0} ${middle(from)}L${x1} ${middle(to)}`} />
              <circle cx={x1} cy={middle(to)} r={4} />
            </g>
          );
        })}
    </g>
  );
}

const SIGNS: readonly (readonly [string, string])[] = [
  ["execution done", t("done")],
  ["execution", t("under way")],
  ["execution planned", t("planned")],
  ["execution put-back", t("not done")],
  ["errand", t("sent, or makes way")],
  ["out", t("out of service")],
];

function Legend() {
  return (
    <ul class="chart-legend small quiet" aria-label={t("Signs of the plan’s rows")}>
      {SIGNS.map(([look, word]) => (
        <li key={word}>
          <svg width="22" height="14" aria-hidden="true">
            <g class={`item ${look}`}>
              <rect class="body" x={1} y={1} width={20} height={12} rx={3} />
            </g>
          </svg>
          {word}
        </li>
      ))}
      <li>
        <svg width="16" height="16" aria-hidden="true">
          <g class="item change">
            <path class="body" d="M8 1l7 7-7 7-7-7z" />
          </g>
        </svg>{t("plan changed")}</li>
      <li>
        <svg width="22" height="14" aria-hidden="true">
          <g class="chart-link">
            <path d="M1 2L17 11" />
            <circle cx={17} cy={11} r={3} />
          </g>
        </svg>{t("handed from robot to robot")}</li>
    </ul>
  );
}

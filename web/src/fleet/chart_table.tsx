// The chart of a fleet in words, the latest first.
import { useState } from "preact/hooks";
import { robotName } from "../question/fault_words";
import { sentence } from "../run/run_words";
import type { ChartRows } from "./chart_rows";
import { wholeClock } from "./fleet_words";
import { t } from "../words/words";

const AT_ONCE = 50;

export function ChartTable({ rows, names }: { rows: ChartRows; names: readonly string[] }) {
  const [most, setMost] = useState(AT_ONCE);
  const all = rows.lanes
    .flatMap((lane) => lane.items.map((item) => ({ who: lane.name, item })))
    .sort((a, b) => b.item.start - a.item.start || b.item.seq - a.item.seq);
  const handed = rows.transfers.map(({ request, from, to, taken_s }) => {
    const [giver = "", taker = ""] = [names[from], names[to]].map((name) => robotName(name ?? ""));
    return t("{giver} hands {request} to {taker} at {time}.", {
      giver,
      request,
      taker,
      time: wholeClock(taken_s),
    });
  });
  return (
    <div class="chart-table" role="region" aria-label={t("The plan as a table")} tabIndex={0}>
      <table>
        <thead>
          <tr>
            <th scope="col">{t("From")}</th>
            <th scope="col">{t("To")}</th>
            <th scope="col">{t("Who")}</th>
            <th scope="col">{t("What, and why")}</th>
          </tr>
        </thead>
        <tbody>
          {all.slice(0, most).map(({ who, item }) => (
            <tr key={item.seq}>
              <td>{wholeClock(item.start)}</td>
              <td>{item.end > item.start ? wholeClock(item.end) : ""}</td>
              <th scope="row">{who}</th>
              <td>{sentence(item.title)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {all.length > most && (
        <button type="button" class="small-button" onClick={() => setMost(most + AT_ONCE)}>
          {t("Show {count} more", { count: Math.min(AT_ONCE, all.length - most) })}
        </button>
      )}
      {handed.length > 0 && <p class="small">{handed.join(" ")}</p>}
    </div>
  );
}

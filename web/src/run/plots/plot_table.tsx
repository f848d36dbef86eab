// The values of a number as a table, for those who hear it or would rather read.
import { useState } from "preact/hooks";
import type { Moment } from "../moment";
import { clock } from "../run_words";
import { countUntil, type Series, told } from "./series";
import { t } from "../../words/words";

const AT_ONCE = 100;

export function PlotTable({ series, moment }: { series: Series; moment: Moment }) {
  const [most, setMost] = useState(AT_ONCE);
  const { points, unit, name } = series;
  const current = countUntil(points, moment.time.value) - 1;
  const left = points.length - most;
  return (
    <div class="plot-table" role="region" aria-label={t("{name} as a table", { name })} tabIndex={0}>
      <table>
        <thead>
          <tr>
            <th scope="col">{t("Time")}</th>
            <th scope="col">{t("Value")}</th>
          </tr>
        </thead>
        <tbody>
          {points.slice(0, most).map((point, index) => (
            <tr key={index} aria-current={index === current ? "time" : undefined}>
              <th scope="row">
                <button type="button" class="bare link" onClick={() => moment.goTo(point.time, point.seq)}>
                  {clock(point.time)}
                </button>
              </th>
              <td>{told(point.value, unit)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {left > 0 && (
        <button type="button" class="small-button" onClick={() => setMost(most + AT_ONCE)}>
          {t("Show {count} more", { count: Math.min(AT_ONCE, left) })}
        </button>
      )}
    </div>
  );
}

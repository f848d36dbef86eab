// Plots of the numbers that a run's events and its recorded poses have, one under the other.
import { useComputed } from "@preact/signals";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { History } from "../history";
import type { Moment } from "../moment";
import { createEventNumbers } from "./event_numbers";
import { PlotDrawing } from "./plot_drawing";
import { PlotTable } from "./plot_table";
import { openPoseNumbers, type PoseNumbers, seriesOf } from "./pose_numbers";
import type { Series } from "./series";
import { whyNotDone } from "../../words/said";
import { t } from "../../words/words";
import "./plots.css";

/** What is recorded meanwhile is read so often, in seconds of the run's clock. */
const READ_EVERY_S = 5;

interface PlotsProps {
  run: string;
  history: History;
  /** Counts up whenever events have come. */
  version: number;
  end: number;
  moment: Moment;
}

export function Plots({ run, history, version, end, moment }: PlotsProps) {
  const [chosen, setChosen] = useState<readonly string[]>([]);
  const ofEvents = useEventSeries(history, version);
  const poses = usePoses(run, moment, chosen.some((id) => id.startsWith("poses/")));
  const known = [...ofEvents.map(({ id, name }) => ({ id, name })), ...(poses.numbers?.numbers ?? [])];
  const choose = (id: string) => {
    if (id !== "" && !chosen.includes(id)) setChosen([...chosen, id]);
  };
  return (
    <div class="plots" id="run-plots">
      <div class="field">
        <label for="plot-number">{t("Number to plot")}</label>
        <select id="plot-number" value="" onChange={(event) => choose(event.currentTarget.value)}>
          <option value="">{known.length === 0 ? t("There are no numbers") : t("Choose one …")}</option>
          <Choices label={t("In events")} names={ofEvents} chosen={chosen} />
          <Choices label={t("In recorded poses")} names={poses.numbers?.numbers ?? []} chosen={chosen} />
        </select>
      </div>
      <p class="mistake small" role="status">
        {poses.failure}
      </p>
      {chosen.map((id) => {
        const series = ofEvents.find((each) => each.id === id) ?? poses.series(id);
        return (
          series !== null && (
            <Plot
              key={id}
              series={series}
              end={end}
              moment={moment}
              onRemove={() => setChosen(chosen.filter((each) => each !== id))}
            />
          )
        );
      })}
    </div>
  );
}

interface ChoicesProps {
  label: string;
  names: readonly { readonly id: string; readonly name: string }[];
  chosen: readonly string[];
}

function Choices({ label, names, chosen }: ChoicesProps) {
  if (names.length === 0) return null;
  return (
    <optgroup label={label}>
      {names.map(({ id, name }) => (
        <option key={id} value={id} disabled={chosen.includes(id)}>
          {name}
        </option>
      ))}
    </optgroup>
  );
}

interface PlotProps {
  series: Series;
  end: number;
  moment: Moment;
  onRemove: () => void;
}

function Plot({ series, end, moment, onRemove }: PlotProps) {
  const [asTable, setAsTable] = useState(false);
  return (
    <section class="plot-panel" aria-label={series.name}>
      <div class="panel-bar">
        <h3>{series.name}</h3>
        <button type="button" class="small-button" aria-pressed={asTable} onClick={() => setAsTable(!asTable)}>{t("As a table")}</button>
        <button type="button" class="small-button" aria-label={t("Remove {name}", { name: series.name })} onClick={onRemove}>
          ✕
        </button>
      </div>
      {asTable ? <PlotTable series={series} moment={moment} /> : <PlotDrawing series={series} end={end} moment={moment} />}
    </section>
  );
}

function useEventSeries(history: History, version: number): readonly Series[] {
  const numbers = useRef(createEventNumbers());
  return useMemo(() => {
    numbers.current.take(history.events);
    return numbers.current.series();
  }, [history, version]);
}

interface Poses {
  readonly numbers: PoseNumbers | null;
  readonly failure: string;
  series(id: string): Series | null;
}

/** The recorded poses, which are read once a number of them is wanted, and then as they grow. */
function usePoses(run: string, moment: Moment, wanted: boolean): Poses {
  const [numbers, setNumbers] = useState<PoseNumbers | null>(null);
  const [failure, setFailure] = useState("");
  const [read, setRead] = useState(0);
  const due = useComputed(() => Math.floor(moment.end.value / READ_EVERY_S)).value;
  useEffect(() => {
    let wantedStill = true;
    openPoseNumbers(run).then(
      (opened) => wantedStill && setNumbers(opened),
      (error: Error) => wantedStill && setFailure(whyNotDone(error)),
    );
    return () => {
      wantedStill = false;
    };
  }, [run]);
  useEffect(() => {
    if (!wanted || numbers === null) return;
    let wantedStill = true;
    numbers.readOn().then(
      (more) => {
        if (!wantedStill) return;
        setFailure("");
        if (more) setRead((times) => times + 1);
      },
      (error: Error) => wantedStill && setFailure(whyNotDone(error)),
    );
    return () => {
      wantedStill = false;
    };
  }, [numbers, wanted, due]);
  return useMemo(() => {
    const made = new Map<string, Series>();
    return {
      numbers,
      failure,
      series(id) {
        const number = numbers?.numbers.find((each) => each.id === id);
        if (number === undefined || numbers === null) return null;
        const known = made.get(id) ?? seriesOf(number, numbers.frames());
        made.set(id, known);
        return known;
      },
    };
  }, [numbers, failure, read]);
}

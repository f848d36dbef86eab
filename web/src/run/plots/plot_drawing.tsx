// One number drawn over the run's clock; the keys go along it from point to point, and the replay with them.
import { useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import UPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Moment } from "../moment";
import { clock } from "../run_words";
import { countUntil, type Point, type Series, told } from "./series";
import { t } from "../../words/words";

const HEIGHT_PX = 150;
const AXIS_PX = 64;
/** Points so close to each other are a line. */
const POINT_PX = 6;
const PAGE = 10;

interface PlotDrawingProps {
  series: Series;
  /** The newest time known, up to which it is drawn. */
  end: number;
  moment: Moment;
}

export function PlotDrawing({ series, end, moment }: PlotDrawingProps) {
  const host = useRef<HTMLDivElement>(null);
  const plot = useRef<UPlot | null>(null);
  const playhead = useRef<HTMLDivElement | null>(null);
  const { points, name, unit } = series;
  const place = () => {
    if (plot.current === null || playhead.current === null) return;
    const x = plot.current.valToPos(moment.time.peek(), "x");
    playhead.current.hidden = !(x >= 0 && x <= plot.current.over.clientWidth);
    playhead.current.style.left = `${x}px`;
  };
  useEffect(() => {
    const element = host.current as HTMLDivElement;
    const made = drawn(element, unit, (time) => moment.goTo(time), place);
    playhead.current = document.createElement("div");
    playhead.current.className = "plot-playhead";
    made.over.append(playhead.current);
    plot.current = made;
    const sized = new ResizeObserver(() => made.setSize({ width: element.clientWidth, height: HEIGHT_PX }));
    sized.observe(element);
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    // Its colours are read when it is drawn.
    const redraw = () => made.redraw(false);
    scheme.addEventListener("change", redraw);
    return () => {
      sized.disconnect();
      scheme.removeEventListener("change", redraw);
      made.destroy();
      plot.current = null;
    };
  }, [unit, moment]);
  useEffect(() => {
    plot.current?.setData([points.map(({ time }) => time), points.map(({ value }) => value)], false);
    plot.current?.setScale("x", { min: 0, max: Math.max(end, 1) });
    place();
  }, [points, points.length, end]);
  useSignalEffect(() => {
    void moment.time.value;
    place();
  });
  const at = countUntil(points, moment.time.value) - 1;
  const shown = points[at];
  const walk = (event: KeyboardEvent) => {
    if (event.shiftKey || event.ctrlKey || event.altKey || event.metaKey) return;
    const next = pointFor(event.key, points, at);
    if (next === undefined) return;
    event.preventDefault();
    moment.goTo(next.time, next.seq);
  };
  return (
    <>
      <p class="small plot-value">
        {shown === undefined ? t("nothing until {time}", { time: clock(moment.time.value) }) : t("{shown} since {time}", { shown: told(shown.value, unit), time: clock(shown.time) })}
      </p>
      <div
        class="plot"
        ref={host}
        role="slider"
        tabIndex={0}
        aria-label={t("{name}; the arrow keys go from value to value", { name })}
        aria-valuemin={1}
        aria-valuemax={Math.max(points.length, 1)}
        aria-valuenow={Math.max(at + 1, 1)}
        aria-valuetext={shown === undefined ? t("no value yet") : t("{shown} at {time}", { shown: told(shown.value, unit), time: clock(shown.time) })}
        onKeyDown={walk}
      />
    </>
  );
}

/** The point to which a key goes from the one at an index; undefined for other keys, and past the ends. */
function pointFor(key: string, points: readonly Point[], at: number): Point | undefined {
  const steps: Readonly<Record<string, number>> = {
    ArrowRight: at + 1,
    ArrowUp: at + 1,
    ArrowLeft: at - 1,
    ArrowDown: at - 1,
    PageUp: Math.min(at + PAGE, points.length - 1),
    PageDown: Math.max(at - PAGE, 0),
    Home: 0,
    End: points.length - 1,
  };
  const index = steps[key];
  return index === undefined ? undefined : points[index];
}

function drawn(host: HTMLElement, unit: string, goTo: (time: number) => void, placed: () => void): UPlot {
  const style = getComputedStyle(host);
  const axis = { stroke: () => style.caretColor, grid: { stroke: () => style.borderTopColor, width: 1 }, ticks: { show: false }, font: "12px system-ui" };
  const made = new UPlot(
    {
      width: Math.max(host.clientWidth, 1),
      height: HEIGHT_PX,
      scales: { x: { time: false }, y: { range: around } },
      legend: { show: false },
      axes: [
        { ...axis, values: (_, times) => times.map((time) => clock(time).replace(".0", "")) },
        { ...axis, size: AXIS_PX, values: (_, values) => values.map((value) => told(value, unit)) },
      ],
      series: [
        {},
        {
          stroke: () => style.color,
          width: 2,
          points: { show: (plot, _, from, to) => to - from < plot.over.clientWidth / POINT_PX, size: 7, fill: () => style.color },
        },
      ],
      cursor: { y: false, points: { show: false }, drag: { setScale: true, x: true, y: false } },
      hooks: { setScale: [placed], setSize: [placed] },
    },
    [[], []],
    host,
  );
  made.over.addEventListener("click", (event) => {
    // What was dragged is looked at more closely instead.
    if (made.select.width === 0) goTo(made.posToVal(event.offsetX, "x"));
  });
  return made;
}

/** A little more than the values, so that none is on the edge; around one that never changes, too. */
function around(_: UPlot, low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [0, 1];
  const room = (high - low) * 0.08 || Math.max(Math.abs(high) * 0.1, 0.1);
  return [low - room, high + room];
}

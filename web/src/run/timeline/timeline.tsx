// The timeline of a run: lanes over its clock, to be looked at closely and to jump from.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import type { Moment } from "../moment";
import type { Lane, TimelineItem } from "./lanes";
import { Lanes } from "./lanes_drawing";
import { TimelineList } from "./list";
import { middleOf, SMALLEST_SPAN_S, type Span, zoomed } from "./span";
import { t } from "../../words/words";
import "./timeline.css";

interface TimelineProps {
  lanes: readonly Lane[];
  /** The newest time known. */
  end: number;
  moment: Moment;
  onChoose: (item: TimelineItem) => void;
  /** More that can be done about it, beside its title. */
  more?: ComponentChildren;
}

export function Timeline(props: TimelineProps) {
  const { lanes, end } = props;
  const [span, setSpan] = useState<Span | null>(null);
  const [asList, setAsList] = useState(false);
  const whole: Span = { from: 0, to: Math.max(end, SMALLEST_SPAN_S) };
  const shown = span ?? whole;
  const zoom = (factor: number, around = middleOf(shown, props.moment.time.peek())) => setSpan(zoomed(shown, factor, around, whole));
  return (
    <section class="timeline" aria-label={t("Timeline")}>
      <div class="panel-bar">
        <h2>{t("Timeline")}</h2>
        {props.more}
        <button type="button" class="small-button" aria-pressed={asList} onClick={() => setAsList(!asList)}>{t("Events as a list")}</button>
        <div class="tree-zoom" role="group" aria-label={t("Span of the timeline")}>
          <button type="button" aria-label={t("Longer span")} disabled={span === null} onClick={() => zoom(2)}>
            −
          </button>
          <button type="button" aria-label={t("The whole run")} onClick={() => setSpan(null)}>{t("Whole")}</button>
          <button
            type="button"
            aria-label={t("Shorter span")}
            disabled={shown.to - shown.from <= SMALLEST_SPAN_S}
            onClick={() => zoom(0.5)}
          >
            +
          </button>
        </div>
      </div>
      {asList ? (
        <TimelineList lanes={lanes} moment={props.moment} onChoose={props.onChoose} />
      ) : (
        <Lanes {...props} span={shown} whole={whole} setSpan={setSpan} zoom={zoom} />
      )}
    </section>
  );
}

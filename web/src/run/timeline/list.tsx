// The timeline as a list, for those who hear it or would rather read.
import { useState } from "preact/hooks";
import type { Moment } from "../moment";
import { clock } from "../run_words";
import type { Lane, LaneKind, TimelineItem } from "./lanes";
import { t } from "../../words/words";

const AT_ONCE = 200;

const KIND_WORDS: Readonly<Record<LaneKind, string>> = {
  steps: t("Start"),
  faults: t("Fault"),
  lost: t("Robot lost"),
  dialogues: t("Dialogue"),
  people: t("Person"),
  waits: t("Waits"),
  resolutions: t("Resolution"),
};

interface TimelineListProps {
  lanes: readonly Lane[];
  moment: Moment;
  onChoose: (item: TimelineItem) => void;
}

export function TimelineList({ lanes, moment, onChoose }: TimelineListProps) {
  const [most, setMost] = useState(AT_ONCE);
  const all = lanes
    .flatMap((lane) => lane.items.map((item) => ({ kind: lane.kind, item })))
    .sort((a, b) => a.item.seq - b.item.seq);
  const current = all.findLast(({ item }) => item.start <= moment.time.value)?.item.seq;
  return (
    <ol class="timeline-list" aria-label={t("Timeline as a list")}>
      {all.slice(0, most).map(({ kind, item }) => (
        <li key={item.seq} aria-current={item.seq === current ? "time" : undefined}>
          <button type="button" class="bare" onClick={() => onChoose(item)}>
            <span>{clock(item.start)}</span> <b>{KIND_WORDS[kind]}</b> {item.title}
          </button>
        </li>
      ))}
      {all.length > most && (
        <li>
          <button type="button" class="bare" onClick={() => setMost(most + AT_ONCE)}>
            {t("Show {count} more", { count: Math.min(AT_ONCE, all.length - most) })}
          </button>
        </li>
      )}
    </ol>
  );
}

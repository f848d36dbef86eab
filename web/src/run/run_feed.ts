// The events of one run: those of the journal, then each new one, drawn at most once a frame.
import { type ReadonlySignal, signal } from "@preact/signals";
import { onEvent, onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { Told } from "../wire/told";
import { ended } from "./fold";
import { createHistory, type History } from "./history";
import { createMoment, type Moment } from "./moment";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

export interface RunFeed {
  readonly history: History;
  readonly moment: Moment;
  /** Counts up whenever events have come: what is drawn from `history` depends on it. */
  readonly version: ReadonlySignal<number>;
  /** Why the run cannot be shown, if it cannot. */
  readonly failure: ReadonlySignal<string | null>;
  close(): void;
}

/** Read a run and follow it until `close`. */
export function openRun(run: string): RunFeed {
  const history = createHistory();
  const moment = createMoment();
  const version = signal(0);
  const failure = signal<string | null>(null);
  let waiting: Told[] = [];
  let reading = false;
  let frame = 0;

  const take = (events: readonly Told[]) => {
    if (!history.add(events)) return;
    const newest = history.stateAfter(history.events.length);
    if (newest === null) return;
    if (ended(newest.status)) moment.finish();
    moment.reach(newest.time);
    version.value++;
  };

  const draw = () => {
    frame = 0;
    if (reading) return;
    const events = waiting;
    waiting = [];
    take(events);
  };

  const read = async () => {
    if (reading) return;
    reading = true;
    try {
      take(await rest.events(run, history.events.at(-1)?.seq ?? 0));
      failure.value = null;
    } catch (error) {
      // What is there stays: the connection comes back with a snapshot, and then it is read again.
      if (history.events.length === 0) failure.value = whyNot(run, error as Error);
    }
    reading = false;
    draw();
  };

  const stops = [
    onSnapshot(() => void read()),
    onEvent((event) => {
      if (event.run !== run) return;
      waiting.push(event);
      frame ||= requestAnimationFrame(draw);
    }),
  ];
  void read();
  return {
    history,
    moment,
    version,
    failure,
    close() {
      for (const stop of stops) stop();
      cancelAnimationFrame(frame);
    },
  };
}

function whyNot(run: string, error: Error): string {
  // An id that is none, and one that no run has, are the same to whoever typed it.
  const none = error instanceof rest.Refusal && (error.status === 404 || error.status === 422);
  return none ? t("There is no run “{run}”.", { run }) : whyNotDone(error);
}

// One run: its events so far, and every new one as it comes.
import { useEffect, useState } from "preact/hooks";
import { onEvent, onSnapshot } from "../state/service";
import * as rest from "../wire/rest";
import type { Event } from "../wire/types";

export function RunView({ run }: { run: string }) {
  const [events, setEvents] = useState<readonly Event[]>([]);
  useEffect(() => {
    const read = () => void rest.events(run).then(setEvents);
    const stop = [
      onSnapshot(read),
      onEvent((event) => {
        if (event.run === run) setEvents((before) => [...before, event]);
      }),
    ];
    read();
    return () => stop.forEach((each) => each());
  }, [run]);
  return (
    <section class="page">
      <h1>Run</h1>
      <ol>
        {events.map((event) => (
          <li key={event.seq}>
            {event.time.toFixed(1)} s {event.type}
          </li>
        ))}
      </ol>
    </section>
  );
}

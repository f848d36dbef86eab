// Panels one at a time where there is no room for all of them.
import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { t } from "../words/words";
import "./tabs.css";

const NARROW = "(width < 720px)";

export interface Panel {
  id: string;
  name: string;
  content: ComponentChildren;
}

export function Tabs({ panels }: { panels: readonly Panel[] }) {
  const [chosen, setChosen] = useState(panels[0]?.id ?? "");
  const bar = useRef<HTMLDivElement>(null);
  const onKeyDown = (event: KeyboardEvent) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const index = panels.findIndex((panel) => panel.id === chosen);
    const next = panels[(index + step + panels.length) % panels.length] as Panel;
    setChosen(next.id);
    bar.current?.querySelector<HTMLElement>(`#tab-${next.id}`)?.focus();
  };
  return (
    <>
      <div class="tabs" role="tablist" aria-label={t("Parts of the run")} ref={bar} onKeyDown={onKeyDown}>
        {panels.map(({ id, name }) => (
          <button
            key={id}
            id={`tab-${id}`}
            type="button"
            class="bare"
            role="tab"
            aria-selected={id === chosen}
            aria-controls={id === chosen ? `panel-${id}` : undefined}
            tabIndex={id === chosen ? 0 : -1}
            onClick={() => setChosen(id)}
          >
            {name}
          </button>
        ))}
      </div>
      {panels
        .filter(({ id }) => id === chosen)
        .map(({ id, content }) => (
          <div key={id} id={`panel-${id}`} class="run-area" role="tabpanel" aria-labelledby={`tab-${id}`}>
            {content}
          </div>
        ))}
    </>
  );
}

/** Whether there is room for one panel only. */
export function useNarrow(): boolean {
  const [narrow, setNarrow] = useState(() => matchMedia(NARROW).matches);
  useEffect(() => {
    const query = matchMedia(NARROW);
    const look = () => setNarrow(query.matches);
    query.addEventListener("change", look);
    return () => query.removeEventListener("change", look);
  }, []);
  return narrow;
}

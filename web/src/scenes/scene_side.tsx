// The scene of the text beside it: drawn from the text, and changed in it.
import { useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../document/document_editor";
import { useRead } from "../document/use_read";
import { sceneActionOf } from "./scene_keys";
import { readScene, type SceneSource, type Thing } from "./scene_source";
import { SceneTools } from "./scene_tools";
import { ThingForm } from "./thing_form";
import { keyOf, thingProblems } from "./thing_problems";
import { TopView } from "./top_view";
import { useSceneHands } from "./use_scene_hands";
import "../trees/editing/editing.css";
import { t } from "../words/words";
import "./scenes.css";

export function SceneSide({ editing }: { editing: Editing }) {
  const { text, says: source } = useRead(editing.text, readScene);
  const last = useRef<SceneSource | null>(null);
  if (source !== null) last.current = source;
  const shown = source ?? last.current;
  if (shown === null) return <p class="quiet">{t("The drawing comes as soon as the text has no mistakes.")}</p>;
  if (shown.elsewhere) return <p class="quiet">{t("This scene is of a building or another world of its own: it is changed as text only.")}</p>;
  return (
    <>
      {source === null && <p class="small quiet">{t("As it was before the mistakes:")}</p>}
      <SceneEditing editing={editing} source={shown} current={source !== null && text === editing.text.text} />
    </>
  );
}

interface SceneEditingProps {
  editing: Editing;
  source: SceneSource;
  /** Whether the source is what the text says now. */
  current: boolean;
}

function SceneEditing({ editing, source, current }: SceneEditingProps) {
  const { text, checked, toLine } = editing;
  const [wanted, setWanted] = useState("");
  const [world, setWorld] = useState("");
  const view = useRef<HTMLDivElement>(null);
  const hands = useSceneHands(text, source, current);
  const problems = useMemo(() => thingProblems(source, checked), [source, checked]);
  const knowing = checked.worlds.filter(({ reach }) => reach.length > 0);
  const limits = knowing.find((each) => each.world === world) ?? knowing[0];
  // There is always a robot.
  const thing = selectedOf(source.things, wanted) as Thing;
  const onKey = (event: KeyboardEvent, at: Thing) => {
    const action = sceneActionOf(event, at.pose, at.kind === "robot");
    if (action === null) return;
    event.preventDefault();
    if ("change" in action) return hands.nudge(at, action.change);
    const next = keyOf(neighbour(source.things, thing, action.go));
    setWanted(next);
    view.current?.querySelector<SVGGElement>(`[data-thing="${next}"]`)?.focus();
  };
  return (
    <>
      <SceneTools text={text} worlds={knowing} shown={limits} onWorld={setWorld} />
      <div ref={view}>
        <TopView
          source={source}
          selected={keyOf(thing)}
          reach={limits?.reach ?? []}
          problems={problems}
          onSelect={setWanted}
          onMove={hands.put}
          onKey={onKey}
        />
      </div>
      <p id="scene-keys" class="small quiet">{t("Drag, or move with the arrow keys by 10 mm and turn with Q and E by 5°; with Shift by 1 mm and 1°. Page Up and Page Down go from one to the next.")}</p>
      <p class="edit-said small" role="status">
        {hands.said}
      </p>
      <ThingForm
        key={keyOf(thing)}
        things={source.things}
        thing={thing}
        tableHeight={source.table.height}
        problems={problems.get(keyOf(thing)) ?? []}
        onSelect={setWanted}
        onMove={(to) => hands.put(thing, to)}
        onShow={() => toLine(source.text.slice(0, thing.span?.[0] ?? 0).split("\n").length)}
      />
    </>
  );
}

/** What is wanted, or else a part. */
function selectedOf(things: readonly Thing[], wanted: string): Thing | undefined {
  return things.find((each) => keyOf(each) === wanted) ?? things.find(({ kind }) => kind === "object") ?? things[0];
}

function neighbour(things: readonly Thing[], thing: Thing, where: "next" | "previous" | "first" | "last"): Thing {
  const count = things.length;
  const index = things.indexOf(thing);
  const to = { next: (index + 1) % count, previous: (index + count - 1) % count, first: 0, last: count - 1 }[where];
  return things[to] as Thing;
}

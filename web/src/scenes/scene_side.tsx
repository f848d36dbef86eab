// The scene of the text beside it: drawn from the text, and changed in it.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../document/document_editor";
import { useRead } from "../document/use_read";
import { AddForm, type Wanted } from "./add_form";
import { freeSpot, nameFor } from "./new_thing";
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
  const [adding, setAdding] = useState<Wanted["kind"] | null>(null);
  const view = useRef<HTMLDivElement>(null);
  const focusNext = useRef<string | null>(null);
  const hands = useSceneHands(text, source, current);
  const problems = useMemo(() => thingProblems(source, checked), [source, checked]);
  const knowing = checked.worlds.filter(({ reach }) => reach.length > 0);
  const limits = knowing.find((each) => each.world === world) ?? knowing[0];
  // There is always a robot.
  const thing = selectedOf(source.things, wanted) as Thing;
  const goTo = (next: string) => {
    setWanted(next);
    focusNext.current = next;
  };
  useEffect(() => {
    if (focusNext.current === null) return;
    // One of several equal ones is called otherwise once another is gone.
    const there = source.things.some((each) => keyOf(each) === focusNext.current) ? focusNext.current : keyOf(thing);
    focusNext.current = null;
    view.current?.querySelector<SVGGElement>(`[data-thing="${there}"]`)?.focus();
  });
  const onKey = (event: KeyboardEvent, at: Thing) => {
    const action = sceneActionOf(event, at);
    if (action === null) return;
    event.preventDefault();
    if ("change" in action) hands.nudge(at, action.change);
    else if ("go" in action) goTo(keyOf(neighbour(source.things, thing, action.go)));
    else if (action.does === "add") setAdding("object");
    else remove(at);
  };
  const remove = (at: Thing) => {
    const next = keyOf(neighbour(source.things, at, "next"));
    hands.remove(at);
    goTo(next);
  };
  const add = (wanted: Wanted) => {
    const size = wanted.kind === "object" ? wanted.size : (sizeOf(source, wanted.name) ?? []);
    const at = freeSpot(wanted.kind, size, source, limits?.reach ?? [], thing.pose);
    if (!hands.add({ ...wanted, at })) return;
    setAdding(null);
    goTo(keyOf(wanted));
  };
  return (
    <>
      <SceneTools text={text} worlds={knowing} shown={limits} onWorld={setWorld} onAdd={setAdding} />
      <div ref={view}>
        <TopView
          source={source}
          selected={keyOf(thing)}
          reach={limits?.reach ?? []}
          problems={problems}
          onSelect={setWanted}
          onChange={hands.put}
          onKey={onKey}
        />
      </div>
      <p id="scene-keys" class="small quiet">{t("Drag, or move with the arrow keys by 10 mm and turn with Q and E by 5°; with Shift by 1 mm and 1°; Alt and an arrow key make a part larger or smaller by 5 mm. The knobs turn it and change its size. N adds a part, Delete takes one out; Page Up and Page Down go from one to the next.")}</p>
      <p class="edit-said small" role="status">
        {hands.said}
      </p>
      {adding !== null && (
        <AddForm key={adding} kind={adding} name={nameFor(adding, source, thing)} onAdd={add} onCancel={() => setAdding(null)} />
      )}
      <ThingForm
        key={keyOf(thing)}
        things={source.things}
        thing={thing}
        tableHeight={source.table.height}
        problems={problems.get(keyOf(thing)) ?? []}
        onSelect={setWanted}
        onMove={(pose) => hands.put(thing, { pose })}
        onSize={(size) => hands.put(thing, { size })}
        onColor={(color) => hands.recolor(thing, color)}
        onRemove={() => remove(thing)}
        onShow={() => toLine(source.text.slice(0, thing.span?.[0] ?? 0).split("\n").length)}
      />
    </>
  );
}

/** What is wanted, or else a part. */
function selectedOf(things: readonly Thing[], wanted: string): Thing | undefined {
  return things.find((each) => keyOf(each) === wanted) ?? things.find(({ kind }) => kind === "object") ?? things[0];
}

/** A place is as large as the part that is called like it. */
function sizeOf({ things }: SceneSource, name: string): readonly number[] | null {
  return things.find((each) => each.kind === "object" && each.name === name)?.size ?? null;
}

function neighbour(things: readonly Thing[], thing: Thing, where: "next" | "previous" | "first" | "last"): Thing {
  const count = things.length;
  const index = things.indexOf(thing);
  const to = { next: (index + 1) % count, previous: (index + count - 1) % count, first: 0, last: count - 1 }[where];
  return things[to] as Thing;
}

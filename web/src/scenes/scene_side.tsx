// The scene of the text beside it: drawn from the text, and changed in it.
import { useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../document/document_editor";
import { plain } from "../tree/words";
import { CannotEdit } from "../yaml_text/source";
import { moved, wrapped } from "./moved_text";
import { type SceneAction, sceneActionOf } from "./scene_keys";
import { type Pose, readScene, type SceneSource, type Thing } from "./scene_source";
import { ThingForm } from "./thing_form";
import { keyOf, thingProblems } from "./thing_problems";
import { TopView } from "./top_view";
import "../trees/editing/editing.css";
import "./scenes.css";

export function SceneSide({ editing }: { editing: Editing }) {
  const { text } = editing.text;
  const source = useMemo(() => readScene(text), [text]);
  const [selected, setSelected] = useState("");
  const last = useRef<SceneSource | null>(null);
  if (source !== null) last.current = source;
  const shown = source ?? last.current;
  if (shown === null) return <p class="quiet">The drawing comes as soon as the text has no mistakes.</p>;
  if (shown.elsewhere) return <p class="quiet">This scene is of a building or another world of its own: it is changed as text only.</p>;
  return (
    <>
      {source === null && <p class="small quiet">As it was before the mistakes:</p>}
      <SceneEditing editing={editing} source={shown} readable={source !== null} selected={selected} onSelect={setSelected} />
    </>
  );
}

interface SceneEditingProps {
  editing: Editing;
  source: SceneSource;
  /** Whether the source is what the text says now. */
  readable: boolean;
  selected: string;
  onSelect: (key: string) => void;
}

function SceneEditing({ editing, source, readable, selected, onSelect }: SceneEditingProps) {
  const { text, checked, toLine } = editing;
  const [said, setSaid] = useState("");
  const [world, setWorld] = useState("");
  const view = useRef<HTMLDivElement>(null);
  const problems = useMemo(() => thingProblems(source, checked), [source, checked]);
  const knowing = checked.worlds.filter(({ reach }) => reach.length > 0);
  const limits = knowing.find((each) => each.world === world) ?? knowing[0];
  const thing = source.things.find((each) => keyOf(each) === selected) ?? (source.things.find(({ kind }) => kind === "object") ?? source.things[0]);
  const change = (one: Thing, to: Partial<Pose>, step: boolean) => {
    if (!readable) return setSaid("The text cannot be read now: put its mistakes right first.");
    try {
      const next = moved(text.text, one, inFile(one, source, to));
      if (step) text.move(next);
      else text.change(next);
      setSaid("");
    } catch (error) {
      if (!(error instanceof CannotEdit)) throw error;
      setSaid(error.message);
    }
  };
  const go = (where: Extract<SceneAction, { go: string }>["go"]) => {
    const next = neighbour(source.things, thing, where);
    onSelect(keyOf(next));
    view.current?.querySelector<SVGGElement>(`[data-thing="${keyOf(next)}"]`)?.focus();
  };
  const onKey = (event: KeyboardEvent, one: Thing) => {
    const action = sceneActionOf(event, one.pose, one.kind === "robot");
    if (action === null) return;
    event.preventDefault();
    if ("go" in action) go(action.go);
    else change(one, action.change, true);
  };
  if (thing === undefined) return <p class="quiet">The scene has nothing in it yet.</p>;
  return (
    <>
      <div class="tree-tools" role="group" aria-label="Change the scene">
        <button type="button" class="tool" disabled={!text.canUndo} onClick={text.undo}>
          Undo
        </button>
        <button type="button" class="tool" disabled={!text.canRedo} onClick={text.redo}>
          Redo
        </button>
        {limits !== undefined && (
          <label class="tool-group small">
            Reach of the robots in
            <select class="tool" value={limits.world} onChange={(event) => setWorld(event.currentTarget.value)}>
              {knowing.map((each) => (
                <option key={each.world} value={each.world}>
                  {plain(each.world)}
                </option>
              ))}
            </select>
          </label>
        )}
      </div>
      <div ref={view}>
        <TopView
          source={source}
          selected={keyOf(thing)}
          reach={limits?.reach ?? []}
          problems={problems}
          onSelect={onSelect}
          onMove={(one, to) => change(one, to, false)}
          onKey={onKey}
        />
      </div>
      <p id="scene-keys" class="small quiet">
        Drag, or move with the arrow keys by 10 mm and turn with Q and E by 5°; with Shift by 1 mm and 1°. Page Up and Page Down go from one to the next.
      </p>
      <p class="edit-said small" role="status">
        {said}
      </p>
      <ThingForm
        key={keyOf(thing)}
        things={source.things}
        thing={thing}
        tableHeight={source.table.height}
        problems={problems.get(keyOf(thing)) ?? []}
        onSelect={onSelect}
        onMove={(to) => change(thing, to, false)}
        onShow={() => toLine(source.text.slice(0, thing.span?.[0] ?? 0).split("\n").length)}
      />
    </>
  );
}

/** What the file is to say: of a grid, where its first one is then. */
function inFile(thing: Thing, { things }: SceneSource, to: Partial<Pose>): Partial<Pose> {
  const first = things.find((each) => each.kind === thing.kind && each.where?.join("/") === thing.where?.join("/")) ?? thing;
  const change = { ...to };
  if (to.x !== undefined) change.x = first.pose.x + to.x - thing.pose.x;
  if (to.y !== undefined) change.y = first.pose.y + to.y - thing.pose.y;
  if (to.yaw !== undefined) change.yaw = wrapped(to.yaw);
  return change;
}

function neighbour(things: readonly Thing[], thing: Thing | undefined, where: "next" | "previous" | "first" | "last"): Thing {
  const count = things.length;
  const index = thing === undefined ? 0 : things.indexOf(thing);
  const to = { next: (index + 1) % count, previous: (index + count - 1) % count, first: 0, last: count - 1 }[where];
  return things[to] as Thing;
}

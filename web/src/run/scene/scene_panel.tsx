// The run's scene: robot and objects in 3-D at the moment that is shown, and what a person may do there.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { helperName } from "../../state/preferences";
import { onEvent, runs } from "../../state/service";
import * as rest from "../../wire/rest";
import type { Intervention } from "../../wire/types";
import type { Moment } from "../moment";
import { offersFor, type Offer, plain, sentenceOn, type Target } from "./interventions";
import { armTarget, ObjectList } from "./object_list";
import { OfferMenu } from "./offer_menu";
import { createPoseSource, type PoseSource } from "./pose_source";
import { SceneCanvas } from "./scene_canvas";
import type { Pointed } from "./scene_view";
import { WhereForm } from "./where_form";
import "./scene.css";

/** The column of the scene is shorter than that of the tree there. */
const ROOM_BELOW = "(720px <= width < 1200px)";

interface OpenMenu {
  readonly target: Target;
  readonly x: number;
  readonly y: number;
}

interface ScenePanelProps {
  run: string;
  moment: Moment;
}

export function ScenePanel({ run, moment }: ScenePanelProps) {
  const source = useMemo(() => createPoseSource(run, helperName.peek(), moment), [run, moment]);
  useEffect(() => () => source.close(), [source]);
  const [pointed, setPointed] = useState<string | null>(null);
  const [menu, setMenu] = useState<OpenMenu | null>(null);
  const [putting, setPutting] = useState<string | null>(null);
  const [failure, setFailure] = useState<string | null>(null);
  const { note, setNote, intervene } = useInterventions(run);
  const [listed, setListed] = useState(() => matchMedia(ROOM_BELOW).matches);
  const list = useRef<HTMLDivElement>(null);

  const layout = source.layout.value;
  const whereabouts = source.whereabouts.value;
  const places = layout?.places.map((each) => each.name) ?? [];
  const running = runs.value.get(run)?.status === "running";
  const offered = layout?.simulated === true && running && moment.live.value;
  const choosing = offered && putting !== null;

  const act = (intervention: Intervention) => {
    setPutting(null);
    void intervene(intervention);
  };
  const toggleList = () => {
    setListed(!listed);
    // What has just been opened must not stay below the edge of what scrolls.
    requestAnimationFrame(() => list.current?.scrollIntoView({ block: "nearest" }));
  };
  const takeOffer = (offer: Offer, target: Target) => {
    setMenu(null);
    if (offer.act !== "where") act(offer.act);
    else if (target.kind === "object") setPutting(target.name);
  };
  const choose = (what: Pointed, at: { x: number; y: number }) => {
    if (choosing) {
      if (what.kind === "table") act({ act: "move", object: putting, to: spotOnTable(what) });
      return;
    }
    const target = what.kind === "table" || !offered ? null : targetOf(what, source);
    setMenu(target === null ? null : { target, ...at });
  };
  const withList = listed || failure !== null;
  return (
    <section class="panel scene" aria-labelledby="scene-title">
      <div class="panel-bar">
        <h2 id="scene-title">Scene</h2>
        {layout !== null && failure === null && (
          <button type="button" class="small-button" aria-expanded={listed} onClick={toggleList}>
            Objects as a list
          </button>
        )}
      </div>
      {layout !== null && failure === null && (
        <SceneCanvas
          layout={layout}
          poses={source}
          pointed={pointed}
          choosing={choosing}
          onPoint={setPointed}
          onChoose={choose}
          onFailure={setFailure}
          onNote={setNote}
        >
          {offered && menu !== null && (
            <OfferMenu
              key={titleOf(menu.target)}
              label={titleOf(menu.target)}
              offers={offersFor(menu.target, places)}
              style={{ "--x": `${menu.x}px`, "--y": `${menu.y}px` }}
              onChoose={(offer) => takeOffer(offer, menu.target)}
              onClose={() => setMenu(null)}
            />
          )}
        </SceneCanvas>
      )}
      {layout !== null && failure !== null && <p>{failure}</p>}
      <p class="scene-state small quiet">{stateSentence(source, moment)}</p>
      <p class="scene-note" role="status">
        {note}
      </p>
      {choosing && (
        <WhereForm
          key={putting}
          object={putting}
          places={places}
          drawn={failure === null}
          onPlace={(place) => act({ act: "place", object: putting, place })}
          onCancel={() => setPutting(null)}
        />
      )}
      {layout !== null && withList && (
        <div ref={list}>
          <ObjectList
            whereabouts={whereabouts}
            places={places}
            offered={offered}
            onChoose={takeOffer}
            onPoint={setPointed}
          />
        </div>
      )}
    </section>
  );
}

function useInterventions(run: string) {
  const [note, setNote] = useState("");
  // The service passes an intervention on at once; whether the world could do it comes as an event.
  useEffect(
    () =>
      onEvent((event) => {
        if (event.type !== "intervention" || event.run !== run) return;
        setNote(event.ok ? sentenceOn(event.intervention) : `That could not be done: ${event.detail}.`);
      }),
    [run],
  );
  const intervene = async (intervention: Intervention) => {
    try {
      await rest.intervene(run, intervention);
    } catch (error) {
      setNote((error as Error).message);
    }
  };
  return { note, setNote, intervene };
}

function targetOf(what: Exclude<Pointed, { kind: "table" }>, source: PoseSource): Target | null {
  const whereabouts = source.whereabouts.peek();
  if (what.kind === "arm") return armTarget(whereabouts);
  const found = whereabouts.find((each) => each.name === what.name);
  return found === undefined ? null : { ...found, kind: "object" };
}

function titleOf(target: Target): string {
  return target.kind === "arm" ? "the arm’s way" : plain(target.name);
}

// To the millimetre: whoever clicks means no more than that.
function spotOnTable({ x, y }: { x: number; y: number }) {
  return { x: Math.round(x * 1000) / 1000, y: Math.round(y * 1000) / 1000 };
}

function stateSentence(source: PoseSource, moment: Moment): string {
  if (!moment.live.value) return source.nothing.value ? "Nothing was recorded of this moment." : "";
  switch (source.state.value) {
    case "lost":
      return "The connection is lost: this is the last that is known.";
    case "refused":
      return "The service does not show this run’s scene.";
    case "ended":
      return source.layout.value === null ? "This run’s robot never said where anything is." : "";
    default:
      return source.layout.value === null ? "Waiting for the robot to say where everything is …" : "";
  }
}

// The run's scene: robot and objects in 3-D at the moment that is shown, and what a person may do there.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { may } from "../../state/access";
import { helperName } from "../../state/preferences";
import { runs } from "../../state/service";
import type { Moment } from "../moment";
import { offersFor, plain, type Target } from "./interventions";
import { ObjectList } from "./object_list";
import { OfferMenu } from "./offer_menu";
import { createPoseSource, type PoseSource } from "./pose_source";
import { SceneCanvas } from "./scene_canvas";
import { useIntervening } from "./intervening";
import { WhereForm } from "./where_form";
import { t } from "../../words/words";
import "./scene.css";

/** The column of the scene is shorter than that of the tree there. */
const ROOM_BELOW = "(720px <= width < 1200px)";

interface ScenePanelProps {
  run: string;
  moment: Moment;
  /** Who of the people is doing something with an object, by its name. */
  doers: ReadonlyMap<string, string>;
}

export function ScenePanel({ run, moment, doers }: ScenePanelProps) {
  const source = useMemo(() => createPoseSource(run, helperName.peek(), moment), [run, moment]);
  useEffect(() => () => source.close(), [source]);
  const [pointed, setPointed] = useState<string | null>(null);
  const [failure, setFailure] = useState<string | null>(null);
  const [listed, setListed] = useState(() => matchMedia(ROOM_BELOW).matches);
  const list = useRef<HTMLDivElement>(null);
  const layout = source.layout.value;
  const places = layout?.places.map((each) => each.name) ?? [];
  const running = runs.value.get(run)?.status === "running";
  const offered = layout?.simulated === true && running && moment.live.value && may("operator");
  const { menu, putting, note, ...doing } = useIntervening(run, offered, source);
  const toggleList = () => {
    setListed(!listed);
    // What has just been opened must not stay below the edge of what scrolls.
    requestAnimationFrame(() => list.current?.scrollIntoView({ block: "nearest" }));
  };
  return (
    <section class="panel scene" aria-labelledby="scene-title">
      <div class="panel-bar">
        <h2 id="scene-title">{t("Scene")}</h2>
        {layout !== null && failure === null && (
          <button type="button" class="small-button" aria-expanded={listed} onClick={toggleList}>
            {t("Objects as a list")}
          </button>
        )}
      </div>
      {layout !== null && failure === null && (
        <SceneCanvas
          layout={layout}
          poses={source}
          pointed={pointed}
          choosing={putting !== null}
          doers={doers}
          onPoint={setPointed}
          onChoose={doing.choose}
          onFailure={setFailure}
          onNote={doing.say}
        >
          {menu !== null && (
            <OfferMenu
              key={titleOf(menu.target)}
              label={titleOf(menu.target)}
              offers={offersFor(menu.target, places)}
              style={{ "--x": `${menu.x}px`, "--y": `${menu.y}px` }}
              onChoose={(offer) => doing.take(offer, menu.target)}
              onClose={doing.closeMenu}
            />
          )}
        </SceneCanvas>
      )}
      {layout !== null && failure !== null && <p>{failure}</p>}
      <p class="scene-state small quiet">{stateSentence(source, moment)}</p>
      <p class="scene-note" role="status">
        {note}
      </p>
      {putting !== null && (
        <WhereForm
          key={putting}
          object={putting}
          places={places}
          drawn={failure === null}
          onPlace={(place) => doing.act({ act: "place", object: putting, place })}
          onCancel={doing.giveUp}
        />
      )}
      {layout !== null && (listed || failure !== null) && (
        <div ref={list}>
          <ObjectList
            whereabouts={source.whereabouts.value}
            places={places}
            doers={doers}
            offered={offered}
            onChoose={doing.take}
            onPoint={setPointed}
          />
        </div>
      )}
    </section>
  );
}

function titleOf(target: Target): string {
  if (target.kind === "object") return plain(target.name);
  return target.kind === "arm" ? t("the arm’s way") : t("the head camera");
}

function stateSentence(source: PoseSource, moment: Moment): string {
  if (!moment.live.value) return source.nothing.value ? t("Nothing was recorded of this moment.") : "";
  switch (source.state.value) {
    case "lost":
      return t("The connection is lost: this is the last that is known.");
    case "refused":
      return t("The service does not show this run’s scene.");
    case "ended":
      return source.layout.value === null ? t("This run’s robot never said where anything is.") : "";
    default:
      return source.layout.value === null ? t("Waiting for the robot to say where everything is …") : "";
  }
}

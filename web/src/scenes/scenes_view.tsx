// The library of scenes: what each has, and the way to its editor.
import { useEffect, useState } from "preact/hooks";
import { may } from "../state/access";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { SceneSummary } from "../wire/types";
import { whyNotDone } from "../words/said";
import { t, tn } from "../words/words";
import "./scenes.css";

export function ScenesView() {
  const [scenes, setScenes] = useState<readonly SceneSummary[] | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  useEffect(() => {
    rest.scenes().then(setScenes, (error: Error) => setMistake(whyNotDone(error)));
  }, [connected]);
  return (
    <section class="page">
      <div class="page-head">
        <h1>{t("Scenes")}</h1>
        <div class="page-actions">
          <a class="button" href="/trees">{t("Task trees")}</a>
          {may("operator") && (
            <a class="button" href="/edit_scene">{t("Write a new one")}</a>
          )}
        </div>
      </div>
      <p class="mistake" role="alert">
        {mistake}
      </p>
      {scenes === null ? <p class="quiet">{t("Loading …")}</p> : <ul class="scene-list">{scenes.map((scene) => <SceneRow key={scene.name} scene={scene} />)}</ul>}
    </section>
  );
}

function SceneRow({ scene }: { scene: SceneSummary }) {
  const { name, built_in, objects, places } = scene;
  return (
    <li class="panel scene-row">
      <div>
        <strong class="library-name">{name}</strong> {built_in && <span class="badge">{t("built in")}</span>}
        <p class="small quiet">{objects === null ? t("It has mistakes by now.") : `${tn("{count} object", "{count} objects", { count: objects })}, ${tn("{count} place", "{count} places", { count: places ?? 0 })}`}</p>
      </div>
      {may("operator") && (
        <a class="button" href={`/edit_scene/${name}`} aria-label={`${built_in ? t("Copy and edit") : t("Edit")} ${name}`}>
          {built_in ? t("Copy and edit") : t("Edit")}
        </a>
      )}
    </li>
  );
}

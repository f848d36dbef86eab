// How robots are drawn: the models that there are, who says to look so, and the way to give one.
import { useEffect, useState } from "preact/hooks";
import { DropZone, FileButton } from "../document/drop_zone";
import { may, whyNot } from "../state/access";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { ModelView, RobotView } from "../wire/types";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import { GiveModel } from "./give_model";
import * as calls from "./model_calls";
import { ACCEPTED, type ModelFile, modelFileOf } from "./model_file";
import { ModelRow } from "./model_row";
import { missingModels, usersOf } from "./model_users";
import "./models.css";

export function ModelsView() {
  const [models, setModels] = useState<readonly ModelView[] | null>(null);
  const [robots, setRobots] = useState<readonly RobotView[]>([]);
  const [given, setGiven] = useState<ModelFile | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  const read = () =>
    Promise.all([calls.models(), rest.robots()]).then(
      ([found, there]) => {
        setModels(found);
        setRobots(there);
      },
      (error: Error) => setMistake(whyNotDone(error)),
    );
  useEffect(() => void read(), [connected]);
  const take = (file: File) => {
    try {
      if (!may("operator")) throw new Error(whyNot(t("Giving a model"), "operator"));
      setGiven(modelFileOf(file));
      setMistake("");
    } catch (error) {
      setMistake(whyNotDone(error));
    }
  };
  return (
    <DropZone
      onFile={take}
      onSeveral={() => setMistake(t("One file at a time, please: a ZIP has all that a model needs."))}
      here={t("Drop the model here")}
    >
      <section class="page">
        <div class="page-head">
          <h1>{t("Robot models")}</h1>
          <div class="page-actions">
            <a class="button" href="/trees">
              {t("Task trees")}
            </a>
            {may("operator") && (
              <FileButton onFile={take} accept={ACCEPTED}>
                {t("Give a model")}
              </FileButton>
            )}
          </div>
        </div>
        <p class="quiet">
          {t("A robot is drawn as the model that it names when it connects. A model is a ZIP with robot.urdf and its meshes, or a URDF that needs none.")}
        </p>
        <p class="mistake" role="alert">
          {mistake}
        </p>
        {given !== null && (
          <GiveModel
            key={given.file.name}
            given={given}
            models={models ?? []}
            missing={missingModels(models ?? [], robots)}
            onKept={() => {
              setGiven(null);
              void read();
            }}
            onCancel={() => setGiven(null)}
          />
        )}
        <Models models={models} robots={robots} onChanged={() => void read()} />
      </section>
    </DropZone>
  );
}

interface ModelsProps {
  models: readonly ModelView[] | null;
  robots: readonly RobotView[];
  onChanged: () => void;
}

function Models({ models, robots, onChanged }: ModelsProps) {
  if (models === null) return <p class="quiet">{t("Loading …")}</p>;
  return (
    <ul class="model-list">
      {models.map((model) => (
        <ModelRow key={model.name} model={model} robots={usersOf(model.name, robots)} onDeleted={onChanged} />
      ))}
      {missingModels(models, robots).map((name) => (
        <li key={name} class="panel model-row">
          <div>
            <strong class="model-name">{name}</strong> <span class="badge">{t("not given")}</span>
            <p class="small quiet">{t("Named by {robots}; a gripper stands for it.", { robots: usersOf(name, robots).join(", ") })}</p>
          </div>
        </li>
      ))}
      {models.length === 0 && <li class="quiet">{t("There is no model yet; a gripper stands for every robot.")}</li>}
    </ul>
  );
}

// One model of the list: whose it is, how large, who names it, and what can be done with it.
import { useState } from "preact/hooks";
import { Confirm } from "../app/confirm";
import { may } from "../state/access";
import type { ModelView } from "../wire/types";
import { whyNotDone } from "../words/said";
import { t, tn } from "../words/words";
import { deleteModel, modelPath } from "./model_calls";

interface ModelRowProps {
  model: ModelView;
  /** The robots that name it. */
  robots: readonly string[];
  onDeleted: () => void;
}

export function ModelRow({ model, robots, onDeleted }: ModelRowProps) {
  const used = robots.length === 0 ? t("No robot names it now.") : t("Named by {robots}.", { robots: robots.join(", ") });
  return (
    <li class="panel model-row">
      <div>
        <strong class="model-name">{model.name}</strong> {model.built_in && <span class="badge">{t("built in")}</span>}
        <p class="small quiet">{`${sizeOf(model)} ${used}`}</p>
      </div>
      {!model.built_in && <ModelActions model={model} robots={robots} onDeleted={onDeleted} />}
    </li>
  );
}

function sizeOf(model: ModelView): string {
  if (model.urdf === null) return t("Its files are not installed.");
  if (model.built_in) return t("It comes with a world.");
  const bytes = model.files.reduce((sum, file) => sum + file.bytes, 0);
  const files = tn("{count} file", "{count} files", { count: model.files.length });
  return t("{files}, {kb} kB.", { files, kb: Math.max(1, Math.round(bytes / 1000)) });
}

function ModelActions({ model: { name }, robots, onDeleted }: ModelRowProps) {
  const [asking, setAsking] = useState(false);
  const [mistake, setMistake] = useState("");
  const remove = async () => {
    setAsking(false);
    try {
      await deleteModel(name);
      onDeleted();
    } catch (error) {
      setMistake(whyNotDone(error));
    }
  };
  return (
    <div class="page-actions">
      <a class="button" href={modelPath(name)} download={`${name}.zip`} aria-label={t("Download {name}", { name })}>
        {t("Download")}
      </a>
      {may("operator") && (
        <button class="button danger" type="button" aria-label={t("Delete {name}", { name })} onClick={() => setAsking(true)}>
          {t("Delete")}
        </button>
      )}
      {mistake !== "" && (
        <p class="mistake" role="alert">
          {mistake}
        </p>
      )}
      {asking && (
        <Confirm
          title={t("Delete '{name}'?", { name })}
          confirm={t("Delete")}
          cancel={t("Keep it")}
          onConfirm={() => void remove()}
          onCancel={() => setAsking(false)}
        >
          {robots.length === 0
            ? t("No robot names it now. What was recorded with it is drawn with a gripper.")
            : t("A gripper then stands for {robots}, also in what was recorded.", { robots: robots.join(", ") })}
        </Confirm>
      )}
    </div>
  );
}

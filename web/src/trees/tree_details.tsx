// One task tree of the library: its drawing, its file, and what can be done with it.
import { useEffect, useState } from "preact/hooks";
import { may } from "../state/access";
import { Confirm } from "../app/confirm";
import { go } from "../app/router";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { DocumentView } from "../wire/types";
import { DefinitionDrawing } from "./definition_drawing";
import { dropDraft } from "../document/draft";
import { whyNotDone } from "../words/said";
import { t, tn } from "../words/words";

export function TreeDetails({ tree }: { tree: string }) {
  const [found, setFound] = useState<DocumentView | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  useEffect(() => {
    rest.tree(tree).then(setFound, (error: Error) => setMistake(whyNotDone(error)));
  }, [tree, connected]);
  if (found === null) return <p class={mistake === "" ? "quiet" : "mistake"}>{mistake || t("Loading …")}</p>;
  const { name, description, scene, nodes } = described(found);
  return (
    <article class="panel tree-details" aria-labelledby="tree-name">
      <div class="page-head">
        <h2 id="tree-name">{name}</h2>
        <TreeActions tree={found} />
      </div>
      {description !== null && <p>{description}</p>}
      <p class="small quiet">
        {tn("{count} node", "{count} nodes", { count: nodes })}
        {scene !== null && (
          <>
            {" "}
            {t("· scene")} {may("operator") ? <a href={`/edit_scene/${scene}`}>{scene}</a> : scene}
          </>
        )}
        {found.built_in && <> {t("· built in: copy it to change it")}</>}
      </p>
      <div class="tree-frame">
        <DefinitionDrawing definition={found.definition} label={t("Drawing of {name}", { name })} />
      </div>
      <details>
        <summary>{t("Its file")}</summary>
        <pre class="tree-file" tabIndex={0} aria-label={t("The file of {name}", { name })}>
          {found.text}
        </pre>
      </details>
    </article>
  );
}

function TreeActions({ tree }: { tree: DocumentView }) {
  const [asking, setAsking] = useState(false);
  const [mistake, setMistake] = useState("");
  const remove = async () => {
    setAsking(false);
    try {
      await rest.deleteTree(tree.name);
      dropDraft(tree.name);
      go("/trees");
    } catch (error) {
      setMistake(whyNotDone(error));
    }
  };
  if (!may("operator")) return null;
  return (
    <div class="page-actions">
      {!tree.built_in && (
        <button class="button danger" type="button" onClick={() => setAsking(true)}>
          {t("Delete")}
        </button>
      )}
      <a class="button" href={`/edit/${tree.name}`}>
        {tree.built_in ? t("Copy and edit") : t("Edit")}
      </a>
      <a class="button primary" href={`/start/${tree.name}`}>
        {t("Start a run")}
      </a>
      {mistake !== "" && (
        <p class="mistake" role="alert">
          {mistake}
        </p>
      )}
      {asking && (
        <Confirm
          title={t("Delete '{name}'?", { name: tree.name })}
          confirm={t("Delete")}
          cancel={t("Keep it")}
          onConfirm={() => void remove()}
          onCancel={() => setAsking(false)}
        >
          {t("The task tree goes from the library for everybody. Runs that were started with it go on.")}
        </Confirm>
      )}
    </div>
  );
}

function described({ name, definition }: DocumentView) {
  const { description, scene, nodes } = definition;
  return {
    name,
    description: typeof description === "string" ? description : null,
    scene: typeof scene === "string" ? scene : null,
    nodes: Array.isArray(nodes) ? nodes.length : 0,
  };
}

// The library of task trees: all of them in a list, and the chosen one beside it.
import { useEffect, useState } from "preact/hooks";
import { may } from "../state/access";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { DocumentSummary } from "../wire/types";
import { DropZone, FileButton } from "../document/drop_zone";
import { TreeDetails } from "./tree_details";
import { takeFile } from "./upload";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./trees.css";

export function TreesView({ tree }: { tree: string | null }) {
  const [trees, setTrees] = useState<readonly DocumentSummary[] | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  useEffect(() => {
    rest.trees().then(setTrees, (error: Error) => setMistake(whyNotDone(error)));
  }, [tree, connected]);
  const take = (file: File) => {
    setMistake("");
    takeFile(file, trees ?? []).catch((error: Error) => setMistake(whyNotDone(error)));
  };
  const chosen = tree ?? trees?.[0]?.name ?? null;
  return (
    <DropZone onFile={take} onSeveral={() => setMistake(t("One task file at a time, please."))} here={t("Drop the task file here")}>
      <section class="page">
        <div class="page-head">
          <h1>{t("Task trees")}</h1>
          <div class="page-actions">
            <a class="button" href="/scenes">
              {t("Scenes")}
            </a>
            <a class="button" href="/models">
              {t("Robot models")}
            </a>
            {may("operator") && (
              <>
                <FileButton onFile={take} accept=".yaml,.yml,.json">
                  {t("Upload a file")}
                </FileButton>
                <a class="button" href="/edit">
                  {t("Write a new one")}
                </a>
              </>
            )}
          </div>
        </div>
        <p class="mistake" role="alert">
          {mistake}
        </p>
        <div class="library">
          <nav class="library-list" aria-label={t("Task trees")}>
            <TreeList trees={trees} chosen={chosen} />
            {may("operator") && (
              <p class="small quiet library-hint">{t("Drop a task file (YAML or JSON) anywhere here to upload it.")}</p>
            )}
          </nav>
          {chosen !== null && <TreeDetails key={chosen} tree={chosen} />}
        </div>
      </section>
    </DropZone>
  );
}

function TreeList({ trees, chosen }: { trees: readonly DocumentSummary[] | null; chosen: string | null }) {
  if (trees === null) return <p class="quiet">{t("Loading …")}</p>;
  return (
    <ul>
      {trees.map(({ name, built_in }) => (
        <li key={name}>
          <a class="library-tree" href={`/trees/${name}`} aria-current={name === chosen ? "page" : undefined}>
            <span class="library-name">{name}</span>
            {built_in && <span class="badge">{t("built in")}</span>}
          </a>
        </li>
      ))}
    </ul>
  );
}

// The editor of a task tree's file: text, mistakes and drawing side by side.
import { useEffect, useState } from "preact/hooks";
import { Confirm } from "../app/confirm";
import { go } from "../app/router";
import * as rest from "../wire/rest";
import type { DocumentSummary } from "../wire/types";
import { useChecked } from "./checked";
import { DefinitionDrawing } from "./definition_drawing";
import { type Draft, dropDraft, keepDraft, keptDraft } from "./draft";
import { Mistakes } from "./mistakes";
import { SaveForm } from "./save_form";
import { type Jump, TextEditor } from "./text_editor";
import { freeName, nameIn, NEW_TREE, renamed } from "./tree_text";
import { useUnsaved } from "./unsaved";
import "./trees.css";

/** What the editor begins with: the text as it is saved, and what was made of it before. */
interface Beginning {
  saved: Draft;
  draft: Draft | null;
  trees: readonly DocumentSummary[];
}

export function TreeEditor({ tree }: { tree: string | null }) {
  const [beginning, setBeginning] = useState<Beginning | null>(null);
  const [mistake, setMistake] = useState("");
  useEffect(() => {
    begin(tree).then(setBeginning, (error: Error) => setMistake(error.message));
  }, [tree]);
  if (beginning !== null) return <Editor tree={tree} {...beginning} />;
  return <p class={mistake === "" ? "page quiet" : "page mistake"}>{mistake || "Loading …"}</p>;
}

async function begin(tree: string | null): Promise<Beginning> {
  const draft = keptDraft(tree);
  const trees = await rest.trees();
  if (tree === null) return { saved: { text: NEW_TREE, name: "my_tree", note: "" }, draft, trees };
  const { text, name, built_in } = await rest.tree(tree);
  if (!built_in) return { saved: { text, name, note: "" }, draft, trees };
  const copy = freeName(name, new Set(trees.map((each) => each.name)));
  const note = `This is a copy of '${name}', which is built in and stays as it is.`;
  return { saved: { text: renamed(text, copy), name: copy, note }, draft, trees };
}

function titleOf(tree: string | null, trees: readonly DocumentSummary[]): string {
  if (tree === null) return "New task tree";
  return trees.some((each) => each.name === tree && each.built_in) ? `Copy of ${tree}` : `Edit ${tree}`;
}

function Editor({ tree, saved, draft, trees }: Beginning & { tree: string | null }) {
  const [{ text, name }, setDraft] = useState(draft ?? saved);
  const [jump, setJump] = useState<Jump | null>(null);
  const checked = useChecked(text);
  const changed = text !== saved.text || name !== saved.name;
  const leaving = useUnsaved(changed);
  const edit = (next: Partial<Draft>) => {
    const now = { text, name, note: draft?.note ?? "", ...next };
    setDraft(now);
    if (now.text === saved.text && now.name === saved.name) dropDraft(tree);
    else keepDraft(tree, now);
  };
  const editText = (next: string) => {
    const named = nameIn(next);
    // The name follows the text's own, until somebody has chosen another.
    edit(nameIn(text) === name && named !== null ? { text: next, name: named } : { text: next });
  };
  const done = (address: string) => {
    dropDraft(tree);
    leaving.allow(() => go(address));
  };
  const wrong = new Set((checked.check?.errors ?? []).flatMap(({ line }) => (line === null ? [] : [line])));
  const about = draft === null ? saved.note : draft.note || "These are changes that were not saved yet.";
  return (
    <section class="page editor-page">
      <h1>{titleOf(tree, trees)}</h1>
      {about !== "" && <p class="note">{about}</p>}
      <SaveForm
        tree={tree}
        text={text}
        name={name}
        trees={trees}
        changed={changed}
        onName={(next) => edit({ name: next })}
        onSaved={(as) => done(`/trees/${as}`)}
        onDiscard={() => done(tree === null ? "/trees" : `/trees/${tree}`)}
      />
      <div class="editor">
        <div class="editor-side">
          <TextEditor
            id="tree-text"
            label="The file of the task tree"
            text={text}
            onText={editText}
            wrong={wrong}
            describedBy="tree-verdict"
            jump={jump}
          />
          <Mistakes id="tree-verdict" checked={checked} onLine={(line) => setJump({ line })} />
        </div>
        <div class="panel editor-drawing">
          {checked.definition === null ? (
            <p class="quiet">The drawing comes as soon as the text has no mistakes.</p>
          ) : (
            <>
              {(checked.check?.errors.length ?? 0) > 0 && (
                <p class="small quiet">As it was before the mistakes:</p>
              )}
              <DefinitionDrawing definition={checked.definition} label="Drawing of this text" />
            </>
          )}
        </div>
      </div>
      {leaving.asked !== null && (
        <Confirm
          title="Leave without saving?"
          confirm="Leave"
          cancel="Keep editing"
          onConfirm={() => leaving.allow(leaving.asked as () => void)}
          onCancel={leaving.stay}
        >
          Your changes stay on this device: you find them when you edit this task tree again.
        </Confirm>
      )}
    </section>
  );
}

// The editor of a file: its text and its mistakes on one side, what the text says drawn on the other.
import type { ComponentChildren } from "preact";
import { useEffect, useState } from "preact/hooks";
import { Confirm } from "../app/confirm";
import { go } from "../app/router";
import type { DocumentSummary } from "../wire/types";
import { freeName, nameIn, renamed } from "../trees/tree_text";
import { type Checked, useChecked } from "./checked";
import type { DocumentKind } from "./document_kind";
import { type Draft, dropDraft, keepDraft, keptDraft } from "./draft";
import { Mistakes } from "./mistakes";
import { SaveForm } from "./save_form";
import { type Jump, TextEditor } from "./text_editor";
import { useUnsaved } from "./unsaved";
import { type EditedText, useText } from "./use_text";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./document_editor.css";

/** What the drawing beside the text knows of it, and can do to it. */
export interface Editing {
  text: EditedText;
  checked: Checked;
  toLine(line: number): void;
}

interface DocumentEditorProps {
  kind: DocumentKind;
  /** Null for a new one. */
  name: string | null;
  drawing: (editing: Editing) => ComponentChildren;
}

/** What the editor begins with: the text as it is saved, and what was made of it before. */
interface Beginning {
  saved: Draft;
  draft: Draft | null;
  others: readonly DocumentSummary[];
}

export function DocumentEditor({ kind, name, drawing }: DocumentEditorProps) {
  const [beginning, setBeginning] = useState<Beginning | null>(null);
  const [mistake, setMistake] = useState("");
  useEffect(() => {
    begin(kind, name).then(setBeginning, (error: Error) => setMistake(whyNotDone(error)));
  }, [name]);
  if (beginning !== null) return <Editor kind={kind} document={name} drawing={drawing} {...beginning} />;
  return <p class={mistake === "" ? "page quiet" : "page mistake"}>{mistake || t("Loading …")}</p>;
}

async function begin(kind: DocumentKind, document: string | null): Promise<Beginning> {
  const draft = keptDraft(kind.draftOf(document));
  const others = await kind.list();
  if (document === null) return { saved: { text: kind.newText, name: kind.newName, note: "" }, draft, others };
  const { text, name, built_in } = await kind.read(document);
  if (!built_in) return { saved: { text, name, note: "" }, draft, others };
  const copy = freeName(name, new Set(others.map((each) => each.name)));
  const note = t("This is a copy of '{name}', which is built in and stays as it is.", { name });
  return { saved: { text: renamed(text, copy), name: copy, note }, draft, others };
}

function titleOf({ said }: DocumentKind, document: string | null, others: readonly DocumentSummary[]): string {
  if (document === null) return t("New: {kind}", { kind: said });
  return others.some((each) => each.name === document && each.built_in)
    ? t("Copy of {document}", { document })
    : t("Edit {document}", { document });
}

type EditorProps = Beginning & { kind: DocumentKind; document: string | null; drawing: DocumentEditorProps["drawing"] };

function Editor({ kind, document, drawing, saved, draft, others }: EditorProps) {
  const [name, setName] = useState((draft ?? saved).name);
  const [jump, setJump] = useState<Jump | null>(null);
  const keep = (now: Pick<Draft, "text" | "name">) => {
    const key = kind.draftOf(document);
    if (now.text === saved.text && now.name === saved.name) dropDraft(key);
    else keepDraft(key, { ...now, note: draft?.note ?? "" });
  };
  const call = (called: string, text: string) => {
    setName(called);
    keep({ text, name: called });
  };
  const text = useText((draft ?? saved).text, (next, before) => {
    // The name follows the text's own, until somebody has chosen another.
    call(nameIn(before) === name ? (nameIn(next) ?? name) : name, next);
  });
  const checked = useChecked(text.text, kind.check);
  const changed = text.text !== saved.text || name !== saved.name;
  const leaving = useUnsaved(changed);
  const done = (address: string) => {
    dropDraft(kind.draftOf(document));
    leaving.allow(() => go(address));
  };
  const toLine = (line: number) => setJump({ line });
  const wrong = new Set((checked.check?.errors ?? []).flatMap(({ line }) => (line === null ? [] : [line])));
  const about = draft === null ? saved.note : draft.note || t("These are changes that were not saved yet.");
  return (
    <section class="page editor-page">
      <h1>{titleOf(kind, document, others)}</h1>
      {about !== "" && <p class="note">{about}</p>}
      <SaveForm
        said={kind.said}
        document={document}
        text={text.text}
        name={name}
        others={others}
        save={kind.save}
        changed={changed}
        onName={(next) => call(next, text.text)}
        onSaved={(as) => done(kind.addressOf(as))}
        onDiscard={() => done(kind.addressOf(document))}
      />
      <div class="editor" onKeyDown={(event) => undoneByKeys(event, text)}>
        <div class="editor-side">
          <TextEditor
            id="document-text"
            label={kind.textLabel}
            text={text.text}
            onText={text.type}
            wrong={wrong}
            describedBy="document-verdict"
            jump={jump}
            caret={text.caret}
            onUndo={text.undo}
            onRedo={text.redo}
          />
          <Mistakes id="document-verdict" checked={checked} onLine={toLine} />
        </div>
        <div class="panel editor-drawing">{drawing({ text, checked, toLine })}</div>
      </div>
      {leaving.asked !== null && (
        <Confirm
          title={t("Leave without saving?")}
          confirm={t("Leave")}
          cancel={t("Keep editing")}
          onConfirm={() => leaving.allow(leaving.asked as () => void)}
          onCancel={leaving.stay}
        >
          {t("Your changes stay on this device: you find them when you edit this {kind} again.", { kind: kind.said })}
        </Confirm>
      )}
    </section>
  );
}

/** One history for text and drawing; a field of a form has its own while it is written in. */
function undoneByKeys(event: KeyboardEvent, text: EditedText): void {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  if (event.target instanceof HTMLInputElement && event.target.type !== "checkbox") return;
  const key = event.key.toLowerCase();
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (key === "y" || event.shiftKey) text.redo();
  else text.undo();
}

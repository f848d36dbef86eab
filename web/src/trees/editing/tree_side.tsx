// The tree of the text beside it: drawn from the text, and changed in it.
import { useMemo, useRef, useState } from "preact/hooks";
import type { Editing } from "../../document/document_editor";
import { useRead } from "../../document/use_read";
import { TreeDrawing } from "../../tree/tree_drawing";
import type { TreeNode } from "../../tree/tree_node";
import { DefinitionDrawing } from "../definition_drawing";
import { drawnNodes } from "./drawn_nodes";
import { LONGEST_TEXT, readTask } from "./task_source";
import { TreeEditing } from "./tree_editing";
import { t } from "../../words/words";
import "./editing.css";

const LABEL = t("Drawing of this text");

export function TreeSide({ editing }: { editing: Editing }) {
  const { text, says: source } = useRead(editing.text, readTask);
  const nodes = useMemo(() => (source === null ? null : drawnNodes(source.tree)), [source]);
  const [selected, setSelected] = useState("/");
  const last = useRef<readonly TreeNode[] | null>(null);
  if (nodes !== null) last.current = nodes;
  if (source === null || nodes === null) return <AsItWas editing={editing} last={last.current} />;
  return <TreeEditing editing={editing} stale={text !== editing.text.text} source={source} nodes={nodes} selected={selected} onSelect={setSelected} />;
}

/** What can be drawn of a text that cannot be changed here: one with mistakes, or in another form. */
function AsItWas({ editing, last }: { editing: Editing; last: readonly TreeNode[] | null }) {
  const { text, checked } = editing;
  const right = checked.text === text.text && checked.check?.definition;
  if (right) {
    const long = text.text.length > LONGEST_TEXT;
    return (
      <>
        <p class="small quiet">
          {long ? t("So long a text is changed as text only:") : t("A tree in the flat form, or with aliases of what follows, is changed as text only:")}
        </p>
        <DefinitionDrawing definition={right} label={LABEL} />
      </>
    );
  }
  if (last === null && checked.definition === null) {
    return <p class="quiet">{t("The drawing comes as soon as the text has no mistakes.")}</p>;
  }
  return (
    <>
      <p class="small quiet">{t("As it was before the mistakes:")}</p>
      {last === null ? <DefinitionDrawing definition={checked.definition ?? {}} label={LABEL} /> : <TreeDrawing nodes={last} label={LABEL} />}
    </>
  );
}

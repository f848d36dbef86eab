// The editor of a task tree's file: text, mistakes and drawing side by side.
import { DocumentEditor } from "../document/document_editor";
import type { DocumentKind } from "../document/document_kind";
import * as rest from "../wire/rest";
import { TreeSide } from "./editing/tree_side";
import { NEW_TREE } from "./tree_text";
import { t } from "../words/words";
import "./trees.css";

const TREE: DocumentKind = {
  said: t("task tree"),
  newName: "my_tree",
  newText: NEW_TREE,
  textLabel: t("The file of the task tree"),
  draftOf: (name) => name,
  addressOf: (name) => (name === null ? "/trees" : `/trees/${name}`),
  list: rest.trees,
  read: rest.tree,
  check: rest.checkTree,
  save: rest.saveTree,
};

export function TreeEditor({ tree }: { tree: string | null }) {
  return <DocumentEditor kind={TREE} name={tree} drawing={(editing) => <TreeSide editing={editing} />} />;
}

// The drawing of a checked definition, as of a tree in the library or in the editor.
import { useMemo } from "preact/hooks";
import { TreeDrawing } from "../tree/tree_drawing";
import { nodesOfDefinition } from "../tree/tree_node";

export function DefinitionDrawing(props: { definition: Readonly<Record<string, unknown>>; label: string }) {
  const nodes = useMemo(() => nodesOfDefinition(props.definition), [props.definition]);
  return <TreeDrawing nodes={nodes} label={props.label} />;
}

// The run's task tree as it stands, with the node at which the robot stopped.
import { useEffect, useState } from "preact/hooks";
import { TreeDrawing } from "../tree/tree_drawing";
import { nodesOfRun, type TreeNode } from "../tree/tree_node";
import * as rest from "../wire/rest";
import { t } from "../words/words";

export function PausedTree({ run, node, name }: { run: string; node: string; name: string }) {
  const [nodes, setNodes] = useState<readonly TreeNode[] | null>(null);
  useEffect(() => {
    let wanted = true;
    rest.run(run).then(
      (view) => wanted && setNodes(nodesOfRun(view.nodes, new Set([node]))),
      // Without it the card lacks a drawing, and nothing that is needed to answer.
      () => undefined,
    );
    return () => {
      wanted = false;
    };
  }, [run, node]);
  if (nodes === null) return <div class="paused-tree" />;
  return (
    <div class="paused-tree">
      <TreeDrawing nodes={nodes} focus={node} compact label={t("Task tree, stopped at {name}", { name })} />
    </div>
  );
}

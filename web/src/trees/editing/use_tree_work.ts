// What an action in the drawing needs to know of the text, and how the text becomes what it makes of it.
import { useMemo, useState } from "preact/hooks";
import type { TreeNode } from "../../tree/tree_node";
import type { GoTo } from "../../tree/walk";
import type { BehaviorView } from "../../wire/types";
import { useBehaviors, useSceneNames } from "./known_names";
import type { SceneNames } from "./new_nodes";
import { parametersOf } from "./parameters";
import type { TaskSource } from "./task_source";
import type { Work } from "./tree_hands";
import { t } from "../../words/words";

export interface TreeWork {
  behaviors: readonly BehaviorView[] | null;
  scene: SceneNames;
  /** What was done last, or why it was not. */
  said: string;
  say: (words: string) => void;
  /** Where the keys go on in the drawing. */
  goTo: GoTo | null;
  toDrawing: (path: string) => void;
  called: (path: string) => string;
  /** After what is done in the drawing itself the keys go on there. */
  work: (inDrawing: boolean) => Work;
}

interface Worked {
  source: TaskSource;
  /** Whether the text has changed since it was read. */
  stale: boolean;
  nodes: readonly TreeNode[];
  selected: string;
  onText: (text: string) => void;
  onSelect: (path: string) => void;
}

export function useTreeWork({ source, stale, nodes, selected, onText, onSelect }: Worked): TreeWork {
  const [goTo, setGoTo] = useState<GoTo | null>(null);
  const [said, say] = useState("");
  const behaviors = useBehaviors();
  const scene = useSceneNames(source.head.scene);
  const names = useMemo(() => new Map(nodes.map(({ path, name }) => [path, name])), [nodes]);
  const called = (path: string) => names.get(path) ?? path;
  const toDrawing = (path: string) => setGoTo({ path });
  const work = (inDrawing: boolean): Work => ({
    text: source.text,
    tree: source.tree,
    selected,
    scene,
    called,
    required: (behavior) => requiredBy(behaviors?.find(({ name }) => name === behavior)?.parameters),
    become: (text, path, told) => {
      if (stale) return say(t("The drawing was not up to date yet: once more, please."));
      onText(text);
      onSelect(path);
      if (inDrawing) toDrawing(path);
      say(told);
    },
    refuse: say,
  });
  return { behaviors, scene, said, say, goTo, toDrawing, called, work };
}

function requiredBy(schema: Readonly<Record<string, unknown>> | undefined): readonly string[] | null {
  return schema === undefined ? null : parametersOf(schema).flatMap(({ key, required }) => (required ? [key] : []));
}

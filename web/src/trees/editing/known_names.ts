// What a tree may name: the behaviors that there are, and what its scene has.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../../wire/rest";
import type { BehaviorView } from "../../wire/types";
import type { SceneNames } from "./new_nodes";

const NOTHING: SceneNames = { objects: [], places: [] };

/** Null until they are known. */
export function useBehaviors(): readonly BehaviorView[] | null {
  const [behaviors, setBehaviors] = useState<readonly BehaviorView[] | null>(null);
  useEffect(() => {
    // Without them leaves are changed as text: the check says what is wrong there.
    rest.behaviors().then(setBehaviors, () => undefined);
  }, []);
  return behaviors;
}

/** The names of a scene; none where there is no such scene. */
export function useSceneNames(scene: unknown): SceneNames {
  const [names, setNames] = useState(NOTHING);
  useEffect(() => {
    if (typeof scene !== "string" || scene === "") return setNames(NOTHING);
    let wanted = true;
    rest.scene(scene).then(
      ({ definition }) => wanted && setNames({ objects: keysOf(definition.objects), places: keysOf(definition.places) }),
      () => wanted && setNames(NOTHING),
    );
    return () => {
      wanted = false;
    };
  }, [scene]);
  return names;
}

function keysOf(value: unknown): string[] {
  return typeof value === "object" && value !== null ? Object.keys(value) : [];
}

// What can be done to the things of a scene, each as one change of the text.
import { useState } from "preact/hooks";
import type { EditedText } from "../document/use_text";
import { CannotEdit } from "../yaml_text/source";
import { moved, wrapped } from "./moved_text";
import type { Pose, SceneSource, Thing } from "./scene_source";
import { t } from "../words/words";

export interface SceneHands {
  /** Why the last thing could not be done; empty if it could. */
  said: string;
  /** Move or turn something to where it is to be. */
  put(thing: Thing, to: Partial<Pose>): void;
  /** As `put`, by one of several keys. */
  nudge(thing: Thing, to: Partial<Pose>): void;
}

/** `current`: whether the source is what the text says now. */
export function useSceneHands(text: EditedText, source: SceneSource, current: boolean): SceneHands {
  const [said, say] = useState("");
  const change = (thing: Thing, to: Partial<Pose>, become: (text: string) => void) => {
    if (!current) return say(t("The drawing is not what the text says now: put the text right, or wait a moment."));
    try {
      become(moved(text.text, thing, inFile(thing, source, to)));
      say("");
    } catch (error) {
      if (!(error instanceof CannotEdit)) throw error;
      say(error.message);
    }
  };
  return { said, put: (thing, to) => change(thing, to, text.change), nudge: (thing, to) => change(thing, to, text.move) };
}

/** What the file is to say: of a grid, where its first one is then. */
function inFile(thing: Thing, { things }: SceneSource, to: Partial<Pose>): Partial<Pose> {
  const first = things.find((each) => each.kind === thing.kind && each.where?.join("/") === thing.where?.join("/")) ?? thing;
  const change = { ...to };
  if (to.x !== undefined) change.x = first.pose.x + to.x - thing.pose.x;
  if (to.y !== undefined) change.y = first.pose.y + to.y - thing.pose.y;
  if (to.yaw !== undefined) change.yaw = wrapped(to.yaw);
  return change;
}

// What can be done to the things of a scene, each as one change of the text.
import { useState } from "preact/hooks";
import type { EditedText } from "../document/use_text";
import { CannotEdit } from "../yaml_text/source";
import { type NewThing, recolored, resized, without, withThing } from "./changed_text";
import { moved, wrapped } from "./moved_text";
import type { Pose, SceneSource, Thing } from "./scene_source";
import type { ThingChange } from "./thing_change";
import { t } from "../words/words";

export interface SceneHands {
  /** Why the last thing could not be done; empty if it could. */
  said: string;
  /** Move or turn something to where it is to be, or make it as large. */
  put(thing: Thing, to: ThingChange): void;
  /** As `put`, by one of several keys. */
  nudge(thing: Thing, to: ThingChange): void;
  recolor(thing: Thing, color: readonly number[]): void;
  /** Whether it was added. */
  add(thing: NewThing): boolean;
  remove(thing: Thing): void;
}

/** `current`: whether the source is what the text says now. */
export function useSceneHands(text: EditedText, source: SceneSource, current: boolean): SceneHands {
  const [said, say] = useState("");
  const change = (changed: (text: string) => string, become: (text: string) => void = text.change): boolean => {
    if (!current) {
      say(t("The drawing is not what the text says now: put the text right, or wait a moment."));
      return false;
    }
    try {
      become(changed(text.text));
      say("");
      return true;
    } catch (error) {
      if (!(error instanceof CannotEdit)) throw error;
      say(error.message);
      return false;
    }
  };
  const changedTo = (thing: Thing, { pose, size }: ThingChange) => (before: string) => {
    const after = pose === undefined ? before : moved(before, thing, inFile(thing, source, pose));
    return size === undefined ? after : resized(after, thing, size);
  };
  return {
    said,
    put: (thing, to) => void change(changedTo(thing, to)),
    nudge: (thing, to) => void change(changedTo(thing, to), text.move),
    recolor: (thing, color) => void change((before) => recolored(before, thing, color)),
    add: (thing) => change((before) => withThing(before, thing)),
    remove: (thing) => void change((before) => without(before, thing)),
  };
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

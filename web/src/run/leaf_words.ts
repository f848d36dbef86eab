// How the console speaks of leaves that people do themselves.
import { plain } from "../tree/words";
import type { LeafSaid, NodeTaken, NodeView } from "../wire/types";
import type { RunState } from "./fold";
import { clock } from "./run_words";
import { t } from "../words/words";

/** Whether somebody may say of a leaf that they do it: its turn has come, and a robot could see it done. */
export function canBeTaken(view: NodeView): boolean {
  const free = !view.active && !view.done && !view.abandoned && view.activation_level > 0;
  return view.kind === "behavior" && free && view.object !== null && view.place !== null;
}

/** Who does a leaf, and when it is done: not when they say so. */
export function beingDone({ name, helper, until, said_done }: NodeTaken, me: string): string {
  const about = { name: plain(name), until: clock(until) };
  if (said_done) {
    return helper === me
      ? t("You say that {name} is done by hand: it is once a robot sees it at its place, until {until}.", about)
      : t("{helper} says that {name} is done by hand: it is once a robot sees it at its place, until {until}.", {
          ...about,
          helper,
        });
  }
  return helper === me
    ? t("You are doing {name}, until {until}: it is done once a robot sees it at its place.", about)
    : t("{helper} is doing {name}, until {until}: it is done once a robot sees it at its place.", { ...about, helper });
}

/** What came of what somebody said of a leaf. */
export function whatWasSaid({ deed, name }: LeafSaid): string {
  return deed === "take"
    ? t("You have taken {name}.", { name: plain(name) })
    : t("You have given {name} back.", { name: plain(name) });
}

/** Who of the people is doing something with which object. */
export function doersOf({ people, shape }: RunState): ReadonlyMap<string, string> {
  const doers = new Map<string, string>();
  for (const [path, { helper }] of people) {
    const index = shape.indices.get(path);
    const object = index === undefined ? undefined : shape.definitions[index]?.parameters?.object;
    if (typeof object === "string") doers.set(object, helper);
  }
  return doers;
}

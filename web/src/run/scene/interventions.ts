// What the simulated person can be told to do with an object or with the arm.
import type { Intervention } from "../../wire/types";
import { t } from "../../words/words";

export interface ObjectTarget {
  readonly kind: "object";
  readonly name: string;
  readonly held: boolean;
  readonly gone: boolean;
}

export interface ArmTarget {
  readonly kind: "arm";
  readonly blocked: boolean;
}

/** The camera on the robot's head; nobody is told whether it is covered. */
export interface HeadTarget {
  readonly kind: "head";
}

export type Target = ObjectTarget | ArmTarget | HeadTarget;

export interface Offer {
  readonly label: string;
  readonly hint: string;
  /** What to do; `where` wants a spot on the table or a place first. */
  readonly act: Intervention | "where";
}

/** What is worth doing now; `places` are the names of the scene's places. */
export function offersFor(target: Target, places: readonly string[]): Offer[] {
  if (target.kind === "arm") return offersForArm(target);
  return target.kind === "head" ? OFFERS_FOR_HEAD : offersForObject(target, places);
}

const OFFERS_FOR_HEAD: Offer[] = [
  { label: t("Cover"), hint: t("Cover the head camera"), act: { act: "cover" } },
  { label: t("Uncover"), hint: t("Clear the view of the head camera"), act: { act: "uncover" } },
];

function offersForArm({ blocked }: ArmTarget): Offer[] {
  return blocked
    ? [{ label: t("Release"), hint: t("Get out of the robot’s way"), act: { act: "release" } }]
    : [{ label: t("Block"), hint: t("Stand in the robot’s way"), act: { act: "block" } }];
}

function offersForObject({ name: object, held, gone }: ObjectTarget, places: readonly string[]): Offer[] {
  const offers: Offer[] = [];
  if (!gone) offers.push({ label: t("Steal"), hint: t("Take it away at once"), act: { act: "steal", object } });
  if (held) {
    const act: Intervention = { act: "steal", object, manner: "pull" };
    offers.push({ label: t("Pull out"), hint: t("Pull it out of the gripper and take it away"), act });
  }
  offers.push({ label: t("Put back"), hint: t("To where it started"), act: { act: "put_back", object } });
  if (places.includes(object)) {
    offers.push({ label: t("Place|to put it there"), hint: t("At its final place"), act: { act: "place", object, place: object } });
  }
  if (!held) {
    offers.push({ label: t("Hand over"), hint: t("Hold it between the fingers"), act: { act: "hand_over", object } });
  }
  offers.push({ label: t("Move …"), hint: t("To a spot on the table or another place"), act: "where" });
  return offers;
}

const DONE: Readonly<Record<Intervention["act"], (object: string) => string>> = {
  steal: (object) => t("The {object} is taken away.", { object }),
  put_back: (object) => t("The {object} is back where it started.", { object }),
  place: (object) => t("The {object} is placed.", { object }),
  hand_over: (object) => t("The {object} is held out to the robot.", { object }),
  move: (object) => t("The {object} is moved.", { object }),
  block: () => t("Somebody stands in the robot’s way."),
  release: () => t("The robot’s way is free."),
  cover: () => t("The head camera is covered."),
  uncover: () => t("The head camera’s view is clear."),
  put_in: () => t("Something is put into the robot’s basket."),
  take_out: () => t("Something is taken out of the robot’s basket."),
  charge: () => t("The robot is plugged in."),
  bar: () => t("A way of the building is barred."),
  clear: () => t("A way of the building is cleared."),
  send_person: () => t("Whom the robot escorts is told to come."),
  misdirect: () => t("A wrong button is pressed in an elevator."),
};

/** One sentence on what was done. */
export function sentenceOn({ act, object }: Intervention): string {
  return DONE[act](plain(object ?? ""));
}

/** A name of the scene as people read it. */
export function plain(name: string): string {
  return name.replaceAll("_", " ");
}

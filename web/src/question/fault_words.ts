// What went wrong, in a sentence for somebody who has never seen the robot.
import type { DialogueView } from "../wire/types";
import { asWritten } from "../words/other_scripts";
import { t } from "../words/words";

type About = Pick<DialogueView, "issue" | "object" | "name" | "robot"> & Partial<Pick<DialogueView, "detection">>;

const SENTENCES: Readonly<Record<string, (part: string) => string>> = {
  missed: (part) => t("The gripper closed, but the {part} is not in it.", { part }),
  dropped: (part) => t("The {part} is no longer in the gripper.", { part }),
  unreachable: (part) => t("The {part} is where the arm cannot grasp it.", { part }),
  positioning: (part) => t("The {part} needs a second hand while the robot places it.", { part }),
  missing: (part) => t("The robot looked for the {part} and cannot see it anywhere.", { part }),
  undone: (part) => t("The {part} is not at its place.", { part }),
  blind: () => t("The robot's head camera does not see what is on the table."),
  lost: () => t("The robot does not know where it is."),
  blocked: () => t("Something is in the way of the robot's arm."),
  item_not_given: () => t("The robot waits for something to be put into its basket."),
  item_not_taken: () => t("The robot waits for something to be taken out of its basket."),
  item_taken: () => t("Something was taken out of the robot's basket on its way."),
  item_missing: () => t("The robot is to hand over something that it was not given."),
  low_battery: () => t("The robot has little left in its battery."),
  nobody_answers: () => t("The robot has told a message, and nobody has said that it was heard."),
  person_not_there: () => t("The robot has come to meet somebody, and sees nobody."),
  fell_behind: () => t("Whom the robot leads does not come after it."),
};

/** Of robots that drive, who see with their lasers. */
const SENTENCES_OF_BASES: Readonly<Record<string, () => string>> = {
  blocked: () => t("The robot does not get on: something is in its way."),
  door_closed: () => t("The robot stands before a door that is shut."),
  elevator_help: () => t("The robot needs somebody for an elevator."),
  wrong_floor: () => t("The robot is in an elevator that has opened at a wrong floor."),
};

/** The kinds of issue that the console has words of its own for. */
export const KNOWN_ISSUES: readonly string[] = [...Object.keys(SENTENCES), ...Object.keys(SENTENCES_OF_BASES)];

/** One sentence about the fault; a kind that the console does not know gets a general one. */
export function faultInWords(about: About): string {
  const ofBases = about.detection?.camera === "laser" ? SENTENCES_OF_BASES[about.issue] : undefined;
  const sentence = ofBases ?? SENTENCES[about.issue];
  if (sentence !== undefined) return sentence(spoken(about.object ?? about.name));
  return t("The robot could not go on with “{name}” ({issue}).", {
    name: spoken(about.name),
    issue: spoken(about.issue),
  });
}

/** A name of the scene or the tree as people say it, without what only tells it from others of the same words. */
export function spoken(identifier: string): string {
  const unmarked = identifier.replaceAll(/(?<=\w)(?<!\bxn|\bq0)--[0-9a-f]{8}(?![0-9A-Za-z_])/g, "");
  return asWritten(unmarked).replaceAll(/[_-]/g, " ");
}

/** What robots call what they sense with. */
const CAMERAS: Readonly<Record<string, string>> = {
  head: t("head"),
  forearm: t("forearm"),
  laser: t("laser"),
  basket: t("basket"),
  gauge: t("gauge"),
  tracker: t("tracker"),
  listening: t("listening"),
};

export function cameraWord(camera: string): string {
  return CAMERAS[camera] ?? spoken(camera);
}

/** A robot's name without the number of its run. */
export function robotName(robot: string): string {
  const [name = robot, ...rest] = robot.split("-");
  return rest.length > 0 && /^[0-9a-f]{8}$/.test(rest.join("-")) ? name.toUpperCase() : spoken(robot);
}

// That the robot of a request waits for people, and what for.
import { robotName } from "../question/fault_words";
import type { RequestView } from "../wire/types";
import { isOver } from "./request_words";
import { t } from "../words/words";
import { Told } from "../words/told";

/** `at`: at whose touch screen that is read. */
export function Waits({ request, at }: { request: RequestView; at?: string | undefined }) {
  const { waits } = request;
  if (waits === null || isOver(request)) return null;
  const { robot, helper, headline } = waits;
  return (
    <span class="waits">
      {helper !== null && t("{robot} waits for {helper}, who has promised to help:", { robot: robotName(robot), helper })}
      {helper === null && (robot === at ? t("I wait for somebody to help me:") : t("{robot} waits for somebody to help:", { robot: robotName(robot) }))}{" "}
      <Told text={headline} />
    </span>
  );
}

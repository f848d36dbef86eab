// The robots of a building in words: where each is, and what it does.
import { ACTIVITY_SIGNS, ACTIVITY_WORDS } from "./at_work";
import type { SeenRobot } from "./seen_robots";
import { t } from "../words/words";

export function RobotList({ seen, onShow }: { seen: readonly SeenRobot[]; onShow(robot: string): void }) {
  return (
    <ul class="plan-robots" aria-label={t("Robots")}>
      {seen.map((each) => (
        <li key={each.robot} class="plan-row">
          <button type="button" class="small-button" disabled={each.where === null} onClick={() => onShow(each.robot)}>
            <span class="unseen">{t("Show")} </span>
            {each.name}
          </button>
          <Doing seen={each} />
          <span class="small">{inWords(each)}</span>
        </li>
      ))}
    </ul>
  );
}

function Doing({ seen: { unseen, activity, where } }: { seen: SeenRobot }) {
  if (unseen !== null || where === null) return <span class="badge plan-badge">{t("✕ Not seen")}</span>;
  return (
    <span class={`badge plan-badge robot-${activity}`}>
      {ACTIVITY_SIGNS[activity]} {ACTIVITY_WORDS[activity]}
    </span>
  );
}

function inWords({ where, doing, unseen }: SeenRobot): string {
  if (where === null) return t("Nobody knows where it is.");
  if (unseen !== null) return `${capital(unseen)}, ${where}.`;
  return `${capital(where)}; ${doing}.`;
}

const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);

// The choices that say what they mean: in which world, and who answers.
import { later } from "../../app/later";
import { plain } from "../../tree/words";
import type { SiteView } from "../../wire/types";
import { siteName } from "../run_words";
import { Mistake } from "./field";
import { type Choices, type Filled, isLive } from "./filled";
import { LiveRobots } from "./live_robots";
import type { StartMistakes } from "./start_mistakes";
import { t } from "../../words/words";

const SitePlan = later(() => import("../../building/site_plan").then((module) => module.SitePlan));

interface PartProps {
  filled: Filled;
  fill: (change: Partial<Filled>) => void;
  mistakes: StartMistakes;
}

export function WorldChoice({ choices, filled, fill, mistakes }: PartProps & { choices: Choices }) {
  const site = choices.sites.find(({ id }) => id === filled.site);
  return (
    <fieldset class="panel" aria-describedby="start-world-mistake">
      <legend>{t("Where")}</legend>
      <div class="choices">
        {choices.worlds.map(({ name, available, reason }) => (
          <label key={name} class="choice">
            <input type="radio" name="world" disabled={!available} checked={filled.site === "" && filled.world === name} onChange={() => fill({ world: name, site: "" })} />
            <span>
              <strong>{name}</strong>
              <span class="small quiet">{reason ?? WORLDS[name] ?? t("A world of its own.")}</span>
            </span>
          </label>
        ))}
        {choices.sites.map((site) => (
          <label key={site.id} class="choice">
            <input type="radio" name="world" checked={filled.site === site.id} onChange={() => fill({ site: site.id })} />
            <span>
              <strong>{t("site {site}", { site: siteName(site) })}</strong>
              <span class="small quiet">{siteWords(site)}</span>
            </span>
          </label>
        ))}
      </div>
      <Mistake field="world" mistakes={mistakes} />
      {site?.world === "building" && <SitePlan scene={site.scene} />}
      {isLive(filled) && <LiveRobots known={choices.robots} filled={filled} fill={fill} />}
      <Mistake field="robots" mistakes={mistakes} />
    </fieldset>
  );
}

/** What is told of a site: where it is, and whether a run could have its robots now. */
export function siteWords({ world, robots }: SiteView): string {
  const free = robots.filter(({ run }) => run === null).length;
  const whose = free === robots.length ? t("no run uses it") : t("{free} of its {robots} robots are free", { free, robots: robots.length });
  return t("A {world} that stays: {whose}. It says its scene, speed and seed.", { world: plain(world), whose });
}

/** What the worlds that come with Mend are; others say nothing of themselves. */
const WORLDS: Readonly<Record<string, string>> = {
  workcell: t("A PR2 at a table, simulated with its cameras and contacts."),
  tabletop: t("The same task without physics: quick, for trying things out."),
  building: t("Floors with doors, and robots that drive there."),
  live: t("Real robots that are connected to this service."),
};

export function AnswerChoice({ scripted, filled, fill, mistakes }: PartProps & { scripted: boolean }) {
  const ways: readonly (readonly [Filled["answers"], string, string, boolean])[] = [
    ["live", t("Live helpers"), t("You, and whoever else has this console open."), true],
    ["scenario", t("The scenario"), scripted ? t("As its script says.") : t("Choose a scenario that has answers first."), scripted],
    ["random", t("Chance"), t("Yes, no or silence, by the seed."), true],
    ["none", t("Nobody"), t("Every question stays without an answer."), true],
  ];
  return (
    <fieldset class="panel" aria-describedby="start-answers-mistake">
      <legend>{t("Who answers the robot")}</legend>
      <div class="choices pairs">
        {ways.map(([value, name, about, possible]) => (
          <label key={value} class="choice">
            <input type="radio" name="answers" disabled={!possible} checked={filled.answers === value} onChange={() => fill({ answers: value })} />
            <span>
              <strong>{name}</strong>
              <span class="small quiet">{about}</span>
            </span>
          </label>
        ))}
      </div>
      <Mistake field="answers" mistakes={mistakes} />
    </fieldset>
  );
}

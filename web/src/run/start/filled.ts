// What can be chosen for a new run, what is filled in, and the request that it makes.
import * as rest from "../../wire/rest";
import type { AutonomyLevel, RobotView, RunRequest, ScenarioSummary, DocumentSummary, SiteView, WorldView } from "../../wire/types";
import { robotsOfRequest } from "./standing";

const LARGEST_SEED = 2 ** 31;
const PREFERRED_WORLD = "workcell";

export interface Choices {
  trees: readonly DocumentSummary[];
  worlds: readonly WorldView[];
  sites: readonly SiteView[];
  scenarios: readonly ScenarioSummary[];
  robots: readonly RobotView[];
}

/** What is filled in, as the fields hold it. */
export interface Filled {
  tree: string;
  world: string;
  /** The id of a site where it is to be; empty for a world of its own. */
  site: string;
  robots: readonly string[];
  /** The robots of the tree's own scene, and which connected one each of them is to be. */
  places: readonly string[];
  standing: Readonly<Record<string, string>>;
  scenario: string;
  speed: string;
  seed: string;
  answers: "live" | "scenario" | "random" | "none";
  interventions: boolean;
  maxAttempts: string;
  autonomy: AutonomyLevel;
}

/** Read what can be chosen. */
export async function readChoices(): Promise<Choices> {
  const [trees, worlds, sites, scenarios, robots] = await Promise.all([
    rest.trees(),
    rest.worlds(),
    rest.sites(),
    rest.scenarios(),
    rest.robots(),
  ]);
  return { trees, worlds: worlds.toSorted((a, b) => rank(a) - rank(b)), sites, scenarios, robots };
}

/** Simulated worlds first, and of these the fullest; most tasks are not of buildings. */
function rank({ name }: WorldView): number {
  if (name === PREFERRED_WORLD) return 0;
  if (name === "building") return 2;
  return name === "live" ? 3 : 1;
}

/** What the form holds at first. */
export function firstFilled(tree: string | null, { trees, worlds }: Choices): Filled {
  const available = worlds.filter((each) => each.available);
  const world = available.find((each) => each.name === PREFERRED_WORLD) ?? available[0];
  return {
    tree: tree ?? trees[0]?.name ?? "",
    world: world?.name ?? "",
    site: "",
    robots: [],
    places: [],
    standing: {},
    scenario: "",
    speed: "1",
    seed: String(Math.floor(Math.random() * LARGEST_SEED)),
    answers: "live",
    interventions: false,
    maxAttempts: "3",
    autonomy: "full",
  };
}

/** What no longer goes together after a change is let go. */
export function settled(filled: Filled, { scenarios }: Choices): Filled {
  const fits = (each: ScenarioSummary) => each.name === filled.scenario && each.tree === filled.tree;
  const scenario = filled.site === "" ? scenarios.find(fits) : undefined;
  const scripted = (scenario?.answers.length ?? 0) > 0;
  return {
    ...filled,
    scenario: scenario?.name ?? "",
    answers: filled.answers === "scenario" && !scripted ? "live" : filled.answers,
  };
}

/** Whether it is to be done by real robots. */
export const isLive = ({ site, world }: Filled): boolean => site === "" && world === "live";

/** The request for what is filled in. */
export function request(filled: Filled): RunRequest {
  const everywhere = {
    tree: filled.tree,
    // An empty field is no number: the service says so at it.
    max_attempts: Number.parseFloat(filled.maxAttempts),
    answers: filled.answers === "scenario" ? null : filled.answers,
    autonomy: filled.autonomy,
  };
  // A site says the rest itself.
  if (filled.site !== "") return { ...everywhere, site: filled.site };
  return {
    ...everywhere,
    world: filled.world,
    robots: isLive(filled) ? robotsOfRequest(filled.robots, filled.standing, filled.places) : [],
    scenario: filled.scenario || null,
    speed: filled.speed === "max" ? "max" : Number(filled.speed),
    seed: Number.parseFloat(filled.seed),
    interventions: filled.interventions && !isLive(filled) ? "random" : null,
  };
}

/** The names to choose from, with the chosen one even where it is gone. */
export function withChosen(names: readonly string[], chosen: string): readonly string[] {
  return names.includes(chosen) || chosen === "" ? names : [...names, chosen];
}

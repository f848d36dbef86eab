// Starting a run: which task tree, where, how fast, and who answers.
import type { ComponentChildren } from "preact";
import { useEffect, useState } from "preact/hooks";
import { go } from "../app/router";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { RobotView, RunRequest, Scenario, TreeSummary, WorldView } from "../wire/types";
import { atTheirFields, type StartField, type StartMistakes } from "./start_mistakes";
import "./start_run.css";

const SPEEDS: readonly (readonly [string, string])[] = [
  ["0.5", "Half speed"],
  ["1", "As in real life"],
  ["2", "Twice as fast"],
  ["5", "5 times as fast"],
  ["20", "20 times as fast"],
  ["max", "As fast as it can"],
];
const LARGEST_SEED = 2 ** 31;
const PREFERRED_WORLD = "workcell";

interface Choices {
  trees: readonly TreeSummary[];
  worlds: readonly WorldView[];
  scenarios: readonly Scenario[];
  robots: readonly RobotView[];
}

/** What is filled in, as the fields hold it. */
interface Filled {
  tree: string;
  world: string;
  robots: readonly string[];
  scenario: string;
  speed: string;
  seed: string;
  answers: "live" | "scenario" | "random" | "none";
  interventions: boolean;
  maxAttempts: string;
}

export function StartRun({ tree }: { tree: string | null }) {
  const [choices, setChoices] = useState<Choices | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  useEffect(() => {
    read().then(setChoices, (error: Error) => setMistake(error.message));
  }, [connected]);
  return (
    <section class="page start-page">
      <h1>Start a run</h1>
      {choices === null ? (
        <p class={mistake === "" ? "quiet" : "mistake"}>{mistake || "Loading …"}</p>
      ) : (
        <StartForm tree={tree} choices={choices} />
      )}
    </section>
  );
}

async function read(): Promise<Choices> {
  const [trees, worlds, scenarios, robots] = await Promise.all([
    rest.trees(),
    rest.worlds(),
    rest.scenarios(),
    rest.robots(),
  ]);
  return { trees, worlds: worlds.toSorted((a, b) => rank(a) - rank(b)), scenarios, robots };
}

/** Simulated worlds first, and of these the fullest. */
function rank({ name }: WorldView): number {
  if (name === PREFERRED_WORLD) return 0;
  return name === "live" ? 2 : 1;
}

function StartForm({ tree, choices }: { tree: string | null; choices: Choices }) {
  const [filled, setFilled] = useState(() => firstFilled(tree, choices));
  const [mistakes, setMistakes] = useState<StartMistakes>({});
  const [starting, setStarting] = useState(false);
  const fill = (change: Partial<Filled>) => setFilled((before) => settled({ ...before, ...change }, choices));
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    setStarting(true);
    setMistakes({});
    try {
      go(`/runs/${(await rest.startRun(request(filled))).id}`);
    } catch (error) {
      const told = error instanceof rest.Refusal && error.errors.length > 0 ? error.errors : [(error as Error).message];
      setMistakes(atTheirFields(told));
      setStarting(false);
    }
  };
  const scenarios = choices.scenarios.filter((each) => each.tree === filled.tree);
  const scenario = scenarios.find((each) => each.name === filled.scenario);
  const number = (name: "seed" | "maxAttempts") => (event: Event) =>
    fill({ [name]: (event.currentTarget as HTMLInputElement).value });
  return (
    <form class="start-form" noValidate onSubmit={(event) => void submit(event)}>
      <fieldset class="panel">
        <legend>What is to be done</legend>
        <Field field="tree" label="Task tree" mistakes={mistakes}>
          <select id="start-tree" {...told("tree", mistakes)} value={filled.tree} onChange={(event) => fill({ tree: event.currentTarget.value })}>
            {withChosen(choices.trees.map(({ name }) => name), filled.tree).map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </Field>
        <Field field="scenario" label="Scenario" mistakes={mistakes} hint={scenario?.description ?? "A script of what goes wrong on the way."}>
          <select id="start-scenario" {...told("scenario", mistakes)} value={filled.scenario} onChange={(event) => fill({ scenario: event.currentTarget.value })}>
            <option value="">None</option>
            {scenarios.map(({ name }) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </Field>
      </fieldset>
      <WorldChoice choices={choices} filled={filled} fill={fill} mistakes={mistakes} />
      <AnswerChoice scripted={(scenario?.answers.length ?? 0) > 0} filled={filled} fill={fill} mistakes={mistakes} />
      <fieldset class="panel">
        <legend>How it goes</legend>
        <div class="start-row">
          <Field field="speed" label="Speed" mistakes={mistakes}>
            <select id="start-speed" {...told("speed", mistakes)} value={filled.speed} onChange={(event) => fill({ speed: event.currentTarget.value })}>
              {SPEEDS.map(([value, text]) => (
                <option key={value} value={value}>
                  {text}
                </option>
              ))}
            </select>
          </Field>
          <Field field="seed" label="Seed" mistakes={mistakes} hint="The same seed gives the same chances again.">
            <input id="start-seed" {...told("seed", mistakes)} type="number" inputMode="numeric" value={filled.seed} onInput={number("seed")} />
          </Field>
          <Field field="max_attempts" label="Attempts" mistakes={mistakes} hint="After so many failed ones a behavior is given up.">
            <input id="start-max_attempts" {...told("max_attempts", mistakes)} type="number" inputMode="numeric" value={filled.maxAttempts} onInput={number("maxAttempts")} />
          </Field>
        </div>
        {filled.world !== "live" && (
          <label class="choice">
            <input type="checkbox" checked={filled.interventions} onChange={(event) => fill({ interventions: event.currentTarget.checked })} />
            <span>
              <strong>Somebody interferes</strong>
              <span class="small quiet">A simulated person steals, moves and blocks by chance.</span>
            </span>
          </label>
        )}
        <Mistake field="interventions" mistakes={mistakes} />
      </fieldset>
      <div class="page-actions">
        <button class="button primary" type="submit" disabled={starting}>
          {starting ? "Starting …" : "Start the run"}
        </button>
        <Mistake field="form" mistakes={mistakes} />
      </div>
    </form>
  );
}

interface PartProps {
  filled: Filled;
  fill: (change: Partial<Filled>) => void;
  mistakes: StartMistakes;
}

function WorldChoice({ choices, filled, fill, mistakes }: PartProps & { choices: Choices }) {
  const toggle = (robot: string, wanted: boolean) =>
    fill({ robots: wanted ? [...filled.robots, robot] : filled.robots.filter((each) => each !== robot) });
  return (
    <fieldset class="panel" aria-describedby="start-world-mistake">
      <legend>Where</legend>
      <div class="choices">
        {choices.worlds.map(({ name, available, reason }) => (
          <label key={name} class="choice">
            <input type="radio" name="world" disabled={!available} checked={filled.world === name} onChange={() => fill({ world: name })} />
            <span>
              <strong>{name}</strong>
              <span class="small quiet">{reason ?? WORLDS[name] ?? "A world of its own."}</span>
            </span>
          </label>
        ))}
      </div>
      <Mistake field="world" mistakes={mistakes} />
      {filled.world === "live" && (
        <fieldset class="start-robots" aria-describedby="start-robots-mistake">
          <legend>Robots</legend>
          {choices.robots.filter((each) => !each.simulated).length === 0 && <p class="quiet">No robot is connected.</p>}
          {choices.robots
            .filter((each) => !each.simulated)
            .map(({ robot, state }) => (
              <label key={robot} class="choice">
                <input type="checkbox" checked={filled.robots.includes(robot)} onChange={(event) => toggle(robot, event.currentTarget.checked)} />
                <span>
                  <strong>{robot}</strong>
                  <span class="small quiet">{state}</span>
                </span>
              </label>
            ))}
        </fieldset>
      )}
      <Mistake field="robots" mistakes={mistakes} />
    </fieldset>
  );
}

/** What the worlds that come with Mend are; others say nothing of themselves. */
const WORLDS: Readonly<Record<string, string>> = {
  workcell: "A PR2 at a table, simulated with its cameras and contacts.",
  tabletop: "The same task without physics: quick, for trying things out.",
  live: "Real robots that are connected to this service.",
};

function AnswerChoice({ scripted, filled, fill, mistakes }: PartProps & { scripted: boolean }) {
  const ways: readonly (readonly [Filled["answers"], string, string, boolean])[] = [
    ["live", "Live helpers", "You, and whoever else has this console open.", true],
    ["scenario", "The scenario", scripted ? "As its script says." : "Choose a scenario that has answers first.", scripted],
    ["random", "Chance", "Yes, no or silence, by the seed.", true],
    ["none", "Nobody", "Every question stays without an answer.", true],
  ];
  return (
    <fieldset class="panel" aria-describedby="start-answers-mistake">
      <legend>Who answers the robot</legend>
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

interface FieldProps {
  field: StartField;
  label: string;
  mistakes: StartMistakes;
  hint?: string;
  children: ComponentChildren;
}

function Field({ field, label, mistakes, hint, children }: FieldProps) {
  return (
    <div class="field">
      <label for={`start-${field}`}>{label}</label>
      {children}
      {hint !== undefined && (
        <p id={`start-${field}-hint`} class="small quiet">
          {hint}
        </p>
      )}
      <Mistake field={field} mistakes={mistakes} />
    </div>
  );
}

function Mistake({ field, mistakes }: { field: StartField | "form"; mistakes: StartMistakes }) {
  return (
    <p id={`start-${field}-mistake`} class="mistake small" role="alert">
      {mistakes[field]}
    </p>
  );
}

/** What ties a control to its hint and its mistake. */
function told(field: StartField, mistakes: StartMistakes) {
  return {
    "aria-invalid": mistakes[field] !== undefined,
    "aria-describedby": `start-${field}-hint start-${field}-mistake`,
  };
}

function firstFilled(tree: string | null, { trees, worlds }: Choices): Filled {
  const available = worlds.filter((each) => each.available);
  const world = available.find((each) => each.name === PREFERRED_WORLD) ?? available[0];
  return {
    tree: tree ?? trees[0]?.name ?? "",
    world: world?.name ?? "",
    robots: [],
    scenario: "",
    speed: "1",
    seed: String(Math.floor(Math.random() * LARGEST_SEED)),
    answers: "live",
    interventions: false,
    maxAttempts: "3",
  };
}

/** What no longer goes together after a change is let go. */
function settled(filled: Filled, { scenarios }: Choices): Filled {
  const scenario = scenarios.find((each) => each.name === filled.scenario && each.tree === filled.tree);
  const scripted = (scenario?.answers.length ?? 0) > 0;
  return {
    ...filled,
    scenario: scenario?.name ?? "",
    answers: filled.answers === "scenario" && !scripted ? "live" : filled.answers,
  };
}

function request(filled: Filled): RunRequest {
  return {
    tree: filled.tree,
    world: filled.world,
    robots: filled.world === "live" ? [...filled.robots] : [],
    scenario: filled.scenario || null,
    speed: filled.speed === "max" ? "max" : Number(filled.speed),
    // An empty field is no number: the service says so at it.
    seed: Number.parseFloat(filled.seed),
    max_attempts: Number.parseFloat(filled.maxAttempts),
    answers: filled.answers === "scenario" ? null : filled.answers,
    interventions: filled.interventions && filled.world !== "live" ? "random" : null,
  };
}

function withChosen(names: readonly string[], chosen: string): readonly string[] {
  return names.includes(chosen) || chosen === "" ? names : [...names, chosen];
}

// Starting a run: which task tree, where, how fast, and who answers.
import { useEffect, useState } from "preact/hooks";
import { may, whyNot } from "../../state/access";
import { go } from "../../app/router";
import { connection } from "../../state/service";
import * as rest from "../../wire/rest";
import type { AutonomyLevel } from "../../wire/types";
import { LevelOptions } from "../steering/autonomy_choice";
import { AnswerChoice, WorldChoice } from "./choices";
import { Field, Mistake, told } from "./field";
import { type Choices, type Filled, firstFilled, isLive, readChoices, request, settled, withChosen } from "./filled";
import { atTheirFields, type StartMistakes } from "./start_mistakes";
import { whyNotDone } from "../../words/said";
import { t } from "../../words/words";
import "./start_run.css";

const SPEEDS: readonly (readonly [string, string])[] = [
  ["0.5", t("Half speed")],
  ["1", t("As in real life")],
  ["2", t("Twice as fast")],
  ["5", t("5 times as fast")],
  ["20", t("20 times as fast")],
  ["max", t("As fast as it can")],
];

export function StartRun({ tree }: { tree: string | null }) {
  const [choices, setChoices] = useState<Choices | null>(null);
  const [mistake, setMistake] = useState("");
  const connected = connection.value === "connected";
  useEffect(() => {
    readChoices().then(setChoices, (error: Error) => setMistake(whyNotDone(error)));
  }, [connected]);
  return (
    <section class="page start-page">
      <h1>{t("Start a run")}</h1>
      {choices === null ? (
        <p class={mistake === "" ? "quiet" : "mistake"}>{mistake || t("Loading …")}</p>
      ) : (
        <StartForm tree={tree} choices={choices} />
      )}
    </section>
  );
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
  const atSite = filled.site !== "";
  const scenarios = choices.scenarios.filter((each) => each.tree === filled.tree);
  const scenario = scenarios.find((each) => each.name === filled.scenario);
  const number = (name: "seed" | "maxAttempts") => (event: Event) =>
    fill({ [name]: (event.currentTarget as HTMLInputElement).value });
  return (
    <form class="start-form" noValidate onSubmit={(event) => void submit(event)}>
      <fieldset class="panel">
        <legend>{t("What is to be done")}</legend>
        <Field field="tree" label={t("Task tree")} mistakes={mistakes}>
          <select id="start-tree" {...told("tree", mistakes)} value={filled.tree} onChange={(event) => fill({ tree: event.currentTarget.value })}>
            {withChosen(choices.trees.map(({ name }) => name), filled.tree).map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </Field>
        {!atSite && (
          <Field field="scenario" label={t("Scenario")} mistakes={mistakes} hint={scenario?.description ?? t("A script of what goes wrong on the way.")}>
            <select id="start-scenario" {...told("scenario", mistakes)} value={filled.scenario} onChange={(event) => fill({ scenario: event.currentTarget.value })}>
              <option value="">{t("None")}</option>
              {scenarios.map(({ name }) => (
                <option key={name}>{name}</option>
              ))}
            </select>
          </Field>
        )}
      </fieldset>
      <WorldChoice choices={choices} filled={filled} fill={fill} mistakes={mistakes} />
      <AnswerChoice scripted={(scenario?.answers.length ?? 0) > 0} filled={filled} fill={fill} mistakes={mistakes} />
      <fieldset class="panel">
        <legend>{t("How it goes")}</legend>
        <div class="start-row">
          {!atSite && (
            <>
              <Field field="speed" label={t("Speed")} mistakes={mistakes}>
                <select id="start-speed" {...told("speed", mistakes)} value={filled.speed} onChange={(event) => fill({ speed: event.currentTarget.value })}>
                  {SPEEDS.map(([value, text]) => (
                    <option key={value} value={value}>
                      {text}
                    </option>
                  ))}
                </select>
              </Field>
              <Field field="seed" label={t("Seed")} mistakes={mistakes} hint={t("The same seed gives the same chances again.")}>
                <input id="start-seed" {...told("seed", mistakes)} type="number" inputMode="numeric" value={filled.seed} onInput={number("seed")} />
              </Field>
            </>
          )}
          <Field field="max_attempts" label={t("Attempts")} mistakes={mistakes} hint={t("After so many failed ones a behavior is given up.")}>
            <input id="start-max_attempts" {...told("max_attempts", mistakes)} type="number" inputMode="numeric" value={filled.maxAttempts} onInput={number("maxAttempts")} />
          </Field>
          <Field field="autonomy" label={t("Autonomy")} mistakes={mistakes} hint={t("Where the robot asks first it waits until an operator lets it go on.")}>
            <select id="start-autonomy" {...told("autonomy", mistakes)} value={filled.autonomy} onChange={(event) => fill({ autonomy: event.currentTarget.value as AutonomyLevel })}>
              <LevelOptions />
            </select>
          </Field>
        </div>
        {!atSite && !isLive(filled) && (
          <label class="choice">
            <input type="checkbox" checked={filled.interventions} onChange={(event) => fill({ interventions: event.currentTarget.checked })} />
            <span>
              <strong>{t("Somebody interferes")}</strong>
              <span class="small quiet">{t("A simulated person steals, moves and blocks by chance.")}</span>
            </span>
          </label>
        )}
        <Mistake field="interventions" mistakes={mistakes} />
      </fieldset>
      <div class="page-actions">
        <button class="button primary" type="submit" disabled={starting || !may("operator")}>
          {starting ? t("Starting …") : t("Start the run")}
        </button>
        {!may("operator") && <p class="quiet">{whyNot(t("Starting a run"), "operator")}</p>}
        <Mistake field="form" mistakes={mistakes} />
      </div>
    </form>
  );
}

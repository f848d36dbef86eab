// The node that is looked at, and the candidates behind the choice of it.
import { KIND_MEANINGS, plain } from "../tree/words";
import type { NodeStarted, NodeView, RunResult } from "../wire/types";
import { whyChosen } from "./choice";
import { clock } from "./run_words";
import { decimal, t } from "../words/words";
import "./choice_panel.css";

const SHOWN_AT_MOST = 12;

interface ChoicePanelProps {
  /** The node that is selected; null for none. */
  node: NodeView | null;
  /** Every choice of the node up to the moment, or of any node while none is selected. */
  choices: readonly NodeStarted[];
  /** Of the run, once it has ended. */
  result: RunResult | null;
  onChoose: (choice: NodeStarted) => void;
}

export function ChoicePanel({ node, choices, result, onChoose }: ChoicePanelProps) {
  const last = choices.at(-1) ?? null;
  return (
    <section class="panel choice-panel" aria-label={t("Choice")}>
      <h2>{node === null ? t("The last choice") : `${plain(node.name)} (${KIND_MEANINGS[node.kind]})`}</h2>
      {last === null ? (
        <p class="quiet small">{node === null ? t("Not started yet.") : notChosen(node, result !== null)}</p>
      ) : (
        <Choice choice={last} />
      )}
      {node !== null && choices.length > 1 && (
        <p class="small choice-earlier">
          {t("Earlier:")}{" "}
          {choices.slice(-9, -1).map((choice) => (
            <button key={choice.seq} type="button" class="bare link" onClick={() => onChoose(choice)}>
              {t("attempt {attempt} at {time}", { attempt: choice.attempt, time: clock(choice.time) })}
            </button>
          ))}
        </p>
      )}
    </section>
  );
}

/** Of a node that no robot has started: a goal, or a leaf that waits or that a person does. */
function notChosen(node: NodeView, ended: boolean): string {
  if (ended && !node.done && !node.abandoned) return t("Not done when the run ended.");
  if (node.kind !== "behavior") return goalText(node);
  if (node.owner !== null) return t("{owner} has taken it.", { owner: node.owner });
  return node.done ? t("Done, and no robot has started it.") : t("Not started yet.");
}

function goalText(node: NodeView): string {
  if (node.done) return t("Done.");
  if (node.abandoned) return t("Given up.");
  return node.activation_level > 0
    ? t("What is under it may be started now.")
    : t("Nothing under it may be started now.");
}

function Choice({ choice }: { choice: NodeStarted }) {
  const shown = choice.candidates.slice(0, SHOWN_AT_MOST);
  const more = choice.candidates.length - shown.length;
  return (
    <>
      <p class="small">
        {t("{time}, {robot}, attempt {attempt}: {choice}", {
          time: clock(choice.time),
          robot: choice.robot,
          attempt: choice.attempt,
          choice: whyChosen(choice),
        })}
      </p>
      <div class="choice-table" role="region" aria-label={t("Candidates")} tabIndex={0}>
        <table>
          <thead>
            <tr>
              <th scope="col">{t("Candidate")}</th>
              <th scope="col">{t("Level")}</th>
              <th scope="col">{t("Potential")}</th>
              <th scope="col">{t("Failed")}</th>
            </tr>
          </thead>
          <tbody>
            {shown.map((candidate) => (
              <tr key={candidate.node} class={candidate.node === choice.node ? "won" : undefined}>
                <th scope="row">
                  {candidate.node === choice.node && <span aria-label={t("taken:")}>✓ </span>}
                  {plain(candidate.name)}
                </th>
                <td>{decimal(candidate.level, 2)}</td>
                <td>{decimal(candidate.potential, 2)}</td>
                <td>{candidate.attempts}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {more > 0 && <p class="quiet small">{t("and {more} more", { more })}</p>}
    </>
  );
}

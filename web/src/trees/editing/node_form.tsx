// What the selected node says, to be changed: its name, its kind, its behavior and the parameters of that.
import { EnteredInput } from "../../document/entered_input";
import type { BehaviorView } from "../../wire/types";
import { KIND_WORDS, plain } from "../../tree/words";
import type { SceneNames } from "./new_nodes";
import { ParameterField } from "./parameter_field";
import { AUTONOMY, type Parameter, parametersOf } from "./parameters";
import { GOAL_KINDS, goalKindOf, type GoalKind, type PlainNode } from "./plain_node";
import { Told } from "../../words/told";
import { t } from "../../words/words";

interface NodeFormProps {
  node: PlainNode;
  /** What the node is called where it has no name of its own. */
  called: string;
  problems: readonly string[];
  behaviors: readonly BehaviorView[] | null;
  scene: SceneNames;
  onKind: (kind: GoalKind) => void;
  /** All that it is to say besides its children. */
  onFill: (values: PlainNode) => void;
  onShow: () => void;
}

export function NodeForm(props: NodeFormProps) {
  const { node, called, problems, onFill, onShow } = props;
  const kind = goalKindOf(node);
  const said = kind === null ? node : withoutKey(node, kind);
  const rename = (name: string) => onFill(name === "" ? withoutKey(said, "name") : { ...said, name });
  return (
    <form class="node-form" aria-label={t("The selected node")} onSubmit={(event) => event.preventDefault()}>
      <div class="node-form-head">
        <h2>{plain(called)}</h2>
        <button type="button" class="tool" onClick={onShow}>
          {t("Show in the text")}
        </button>
      </div>
      {problems.map((problem) => (
        <p key={problem} class="mistake-line">
          <Told text={problem} />
        </p>
      ))}
      <div class="node-fields">
        <div class="field">
          <label for="node-name">{t("Name of this node")}</label>
          <EnteredInput
            id="node-name"
            class="mono"
            value={typeof node.name === "string" ? node.name : ""}
            placeholder={called}
            maxlength={64}
            spellcheck={false}
            autocomplete="off"
            onEnter={(input) => rename(input.value.trim())}
          />
        </div>
        {kind === null ? <LeafFields {...props} /> : <KindField kind={kind} onKind={props.onKind} />}
      </div>
    </form>
  );
}

function KindField({ kind, onKind }: { kind: GoalKind; onKind: (kind: GoalKind) => void }) {
  return (
    <div class="field">
      <label for="node-kind">{t("Kind")}</label>
      <select id="node-kind" value={kind} onChange={(event) => onKind(event.currentTarget.value as GoalKind)}>
        {GOAL_KINDS.map((each) => (
          <option key={each} value={each}>
            {KIND_WORDS[each]}
          </option>
        ))}
      </select>
    </div>
  );
}

function LeafFields({ node, behaviors, scene, onFill }: NodeFormProps) {
  const behavior = typeof node.behavior === "string" ? node.behavior : "";
  const known = behaviors?.find(({ name }) => name === behavior);
  const parameters = [...(known === undefined ? [] : parametersOf(known.parameters)), AUTONOMY];
  const keys = new Set(["name", "behavior", ...parameters.map(({ key }) => key)]);
  const unknown = known === undefined ? [] : Object.keys(node).filter((key) => !keys.has(key));
  const set = (key: string, value: unknown) => onFill(value === undefined ? withoutKey(node, key) : { ...node, [key]: value });
  return (
    <>
      <div class="field">
        <label for="node-behavior">{t("Behavior")}</label>
        <select id="node-behavior" value={behavior} onChange={(event) => onFill(withBehavior(node, event.currentTarget.value, behaviors))}>
          {known === undefined && <option value={behavior}>{behavior === "" ? t("none yet") : behavior}</option>}
          {behaviors?.map(({ name }) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
        </select>
      </div>
      {parameters.map((parameter) => (
        <ParameterField
          key={parameter.key}
          parameter={parameter}
          value={node[parameter.key]}
          names={namesFor(parameter, scene)}
          onValue={(value) => set(parameter.key, value)}
        />
      ))}
      {unknown.map((key) => (
        <div key={key} class="field">
          <span class="label">{key}</span>
          <button type="button" class="tool" onClick={() => set(key, undefined)}>
            {t("Remove '{key}', which {behavior} does not have", { key, behavior })}
          </button>
        </div>
      ))}
    </>
  );
}

function namesFor({ key }: Parameter, { objects, places }: SceneNames): readonly string[] {
  if (key === "object") return objects;
  return key === "place" ? places : [];
}

/** A leaf of another behavior: what that has, too, stays. */
function withBehavior(node: PlainNode, behavior: string, behaviors: readonly BehaviorView[] | null): PlainNode {
  const known = behaviors?.find(({ name }) => name === behavior);
  const kept = new Set(["name", AUTONOMY.key, ...(known === undefined ? [] : parametersOf(known.parameters).map(({ key }) => key))]);
  const stays = Object.entries(node).filter(([key]) => kept.has(key));
  return { behavior, ...Object.fromEntries(stays) };
}

function withoutKey(node: PlainNode, without: string): PlainNode {
  return Object.fromEntries(Object.entries(node).filter(([key]) => key !== without));
}

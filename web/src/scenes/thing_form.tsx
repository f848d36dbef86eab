// The selected thing of a scene in numbers, to be changed.
import { EnteredInput } from "../document/entered_input";
import { plain } from "../tree/words";
import { linearColor, screenColor } from "./colors";
import type { Pose, Thing } from "./scene_source";
import { SizeFields } from "./size_fields";
import { keyOf, type ThingProblem } from "./thing_problems";
import { Told } from "../words/told";
import { t } from "../words/words";

interface ThingFormProps {
  things: readonly Thing[];
  thing: Thing;
  /** Of the table, where the thing says no height. */
  tableHeight: number;
  problems: readonly ThingProblem[];
  onSelect: (key: string) => void;
  onMove: (change: Partial<Pose>) => void;
  onSize: (size: readonly number[]) => void;
  onColor: (color: readonly number[]) => void;
  onRemove: () => void;
  onShow: () => void;
}

const GROUPS: readonly (readonly [Thing["kind"], string])[] = [
  ["object", t("Parts")],
  ["place", t("Places")],
  ["robot", t("Robots")],
];
const DEGREES = 180 / Math.PI;

export function ThingForm(props: ThingFormProps) {
  const { things, thing, problems, onSelect, onShow, onRemove } = props;
  return (
    <form class="node-form" aria-label={t("The selected thing")} onSubmit={(event) => event.preventDefault()}>
      <div class="node-form-head">
        <div class="field">
          <label for="scene-thing">{t("Selected")}</label>
          <select id="scene-thing" value={keyOf(thing)} onChange={(event) => onSelect(event.currentTarget.value)}>
            {GROUPS.map(([kind, said]) => (
              <optgroup key={kind} label={said}>
                {things
                  .filter((each) => each.kind === kind)
                  .map((each) => (
                    <option key={keyOf(each)} value={keyOf(each)}>
                      {plain(each.name)}
                    </option>
                  ))}
              </optgroup>
            ))}
          </select>
        </div>
        {thing.span !== null && (
          <div class="tool-group">
            <button type="button" class="tool" onClick={onShow}>
              {t("Show in the text")}
            </button>
            <button type="button" class="tool" aria-label={t("Take out {name}", { name: plain(thing.name) })} onClick={onRemove}>
              {t("Take out")}
            </button>
          </div>
        )}
      </div>
      {problems.map(({ message, mistake }) => (
        <p key={message} class={mistake ? "mistake-line" : "doubt-line"}>
          <Told text={message} />
        </p>
      ))}
      {thing.where === null ? (
        <p class="small quiet">{t("The file names no robot, so one stands in the middle. To move it, add it to 'robots' in the text.")}</p>
      ) : (
        <>
          <Numbers {...props} />
          {thing.kind === "object" && <Looks {...props} />}
        </>
      )}
    </form>
  );
}

function Numbers({ thing, tableHeight, onMove }: ThingFormProps) {
  const { pose, together, kind } = thing;
  const enter = ({ value, valueAsNumber }: HTMLInputElement, change: (value: number) => Partial<Pose>) => {
    if (value !== "" && Number.isFinite(valueAsNumber)) onMove(change(valueAsNumber));
  };
  const bottom = kind === "robot" ? 0 : tableHeight;
  return (
    <>
      {together > 1 && <p class="small quiet">{t("It is one of {together} in a grid, which move, turn and go together.", { together })}</p>}
      <div class="node-fields">
        <div class="field">
          <label for="thing-x">{t("Forward x (m)")}</label>
          <EnteredInput id="thing-x" type="number" step="0.001" value={shown(pose.x)} onEnter={(input) => enter(input, (x) => ({ x }))} />
        </div>
        <div class="field">
          <label for="thing-y">{t("Left y (m)")}</label>
          <EnteredInput id="thing-y" type="number" step="0.001" value={shown(pose.y)} onEnter={(input) => enter(input, (y) => ({ y }))} />
        </div>
        <div class="field">
          <label for="thing-z">{t("Bottom z (m)")}</label>
          <EnteredInput
            id="thing-z"
            type="number"
            step="0.001"
            value={pose.z === null ? "" : shown(pose.z)}
            placeholder={kind === "robot" ? t("0 (the floor)") : t("{bottom} (the table)", { bottom: shown(bottom) })}
            onEnter={(input) => (input.value === "" ? onMove({ z: null }) : enter(input, (z) => ({ z })))}
          />
        </div>
        <div class="field">
          <label for="thing-yaw">{t("Turned left (degrees)")}</label>
          <EnteredInput
            id="thing-yaw"
            type="number"
            step={kind === "robot" ? 90 : 1}
            value={shown(pose.yaw * DEGREES)}
            onEnter={(input) => enter(input, (degrees) => ({ yaw: degrees / DEGREES }))}
          />
        </div>
      </div>
    </>
  );
}

function Looks({ thing, things, onSize, onColor }: ThingFormProps) {
  const { owner, size, color } = thing;
  const equal = things.filter((each) => each.owner?.join("/") === owner?.join("/")).length;
  return (
    <>
      {equal > 1 && <p class="small quiet">{t("Its size and colour are those of all {equal} that are equal.", { equal })}</p>}
      <div class="node-fields">
        {size !== null && <SizeFields id="thing" size={size} onSize={onSize} />}
        <div class="field">
          <label for="thing-color">{t("Colour")}</label>
          <input id="thing-color" type="color" value={screenColor(color)} onChange={(event) => onColor(linearColor(event.currentTarget.value))} />
        </div>
      </div>
    </>
  );
}

function shown(value: number): string {
  return String(Number(value.toFixed(3)));
}

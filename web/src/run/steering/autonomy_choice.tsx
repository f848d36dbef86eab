// How much the robots may do without being asked.
import { useId } from "preact/hooks";
import type { AutonomyLevel } from "../../wire/types";
import { LEVELS } from "./steering_fold";
import { LEVEL_WORDS } from "./steering_words";
import { t } from "../../words/words";

interface AutonomyChoiceProps {
  level: AutonomyLevel;
  disabled: boolean;
  /** Resolves with whether it was taken. */
  onChoose(level: AutonomyLevel): Promise<boolean>;
}

export function AutonomyChoice({ level, disabled, onChoose }: AutonomyChoiceProps) {
  const id = useId();
  return (
    <div class="steering-row">
      <label class="small" for={id}>
        {t("Autonomy")}
      </label>
      <select
        id={id}
        class="input"
        value={level}
        disabled={disabled}
        onChange={(event) => {
          const select = event.currentTarget;
          // What is shown is what the run has, until that has changed.
          void onChoose(select.value as AutonomyLevel).then((taken) => {
            if (!taken) select.value = level;
          });
        }}
      >
        <LevelOptions />
      </select>
    </div>
  );
}

export function LevelOptions() {
  return (
    <>
      {LEVELS.map((level) => (
        <option key={level} value={level}>
          {`${level}: ${LEVEL_WORDS[level]}`}
        </option>
      ))}
    </>
  );
}

// The buttons of a scene's editor, and whose reach is shown.
import type { EditedText } from "../document/use_text";
import { plain } from "../tree/words";
import type { WorldFit } from "../wire/types";
import { t } from "../words/words";

interface SceneToolsProps {
  text: EditedText;
  /** The worlds that know how far their robots reach. */
  worlds: readonly WorldFit[];
  shown: WorldFit | undefined;
  onWorld: (world: string) => void;
  onAdd: (kind: "object" | "place") => void;
}

export function SceneTools({ text, worlds, shown, onWorld, onAdd }: SceneToolsProps) {
  return (
    <div class="tree-tools" role="group" aria-label={t("Change the scene")}>
      <div class="tool-group">
        <button type="button" class="tool" disabled={!text.canUndo} onClick={text.undo}>
          {t("Undo")}
        </button>
        <button type="button" class="tool" disabled={!text.canRedo} onClick={text.redo}>
          {t("Redo")}
        </button>
      </div>
      <div class="tool-group">
        <button type="button" class="tool" onClick={() => onAdd("object")}>
          {t("Add a part")}
        </button>
        <button type="button" class="tool" onClick={() => onAdd("place")}>
          {t("Add a place")}
        </button>
      </div>
      {shown !== undefined && (
        <label class="tool-group small">
          {t("Reach of the robots in")}
          <select class="tool" value={shown.world} onChange={(event) => onWorld(event.currentTarget.value)}>
            {worlds.map(({ world }) => (
              <option key={world} value={world}>
                {plain(world)}
              </option>
            ))}
          </select>
        </label>
      )}
    </div>
  );
}

// What can be done with the 3-D picture by button.
import type { SceneView } from "./scene_view";
import { t } from "../../words/words";

interface Props {
  view: SceneView | null;
  names: boolean;
  onNames(on: boolean): void;
}

export function CameraButtons({ view, names, onNames }: Props) {
  return (
    <div class="scene-tools" role="group" aria-label={t("3-D view")}>
      <button type="button" class="button" aria-pressed={names} onClick={() => onNames(!names)}>
        {t("Names")}
      </button>
      <button type="button" class="button square" aria-label={t("Zoom in")} onClick={() => view?.zoom(true)}>
        +
      </button>
      <button type="button" class="button square" aria-label={t("Zoom out")} onClick={() => view?.zoom(false)}>
        −
      </button>
      <button type="button" class="button" onClick={() => view?.resetCamera()}>
        {t("Reset")}
      </button>
    </div>
  );
}

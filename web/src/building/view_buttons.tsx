// What can be done with a plan by button.
import type { SightControls } from "./use_sight";
import { t } from "../words/words";

export function ViewButtons({ controls }: { controls: SightControls }) {
  return (
    <div class="plan-tools" role="group" aria-label={t("Plan")}>
      <button type="button" class="small-button" aria-label={t("Zoom in")} onClick={controls.zoomIn}>
        +
      </button>
      <button type="button" class="small-button" aria-label={t("Zoom out")} onClick={controls.zoomOut}>
        −
      </button>
      <button type="button" class="small-button" onClick={controls.fit}>
        {t("Fit")}
      </button>
    </div>
  );
}

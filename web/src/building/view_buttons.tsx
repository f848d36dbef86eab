// What can be done with a plan by button.
import type { SightControls } from "./use_sight";

export function ViewButtons({ controls }: { controls: SightControls }) {
  return (
    <div class="plan-tools" role="group" aria-label="Plan">
      <button type="button" class="small-button" aria-label="Zoom in" onClick={controls.zoomIn}>
        +
      </button>
      <button type="button" class="small-button" aria-label="Zoom out" onClick={controls.zoomOut}>
        −
      </button>
      <button type="button" class="small-button" onClick={controls.fit}>
        Fit
      </button>
    </div>
  );
}

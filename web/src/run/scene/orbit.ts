// How the helper looks at the scene: round the table, by pointer, by touch and by key.
import { MathUtils, type PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const NEAREST_M = 0.5;
const FARTHEST_M = 5;
const LOWEST_RAD = 1.5;
const STEP_RAD = 0.12;
const ZOOM_STEP = 0.85;
const PAN_LIMIT_M = 1.2;

export interface Orbit {
  /** Look from where one sees table and robot. */
  reset(): void;
  lookAt(target: Vector3): void;
  turn(azimuth: number, polar: number): void;
  zoom(nearer: boolean): void;
  /** Keep everything in sight in a view of this width to height. */
  fit(aspect: number): void;
  /** Go on with a motion that runs out; whether there is more of it. */
  update(): boolean;
  dispose(): void;
}

export function createOrbit(camera: PerspectiveCamera, canvas: HTMLCanvasElement, changed: () => void): Orbit {
  camera.up.set(0, 0, 1);
  const home = new Vector3(0.55, -0.1, 0.72);
  const controls = new OrbitControls(camera, canvas);
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const heed = () => {
    controls.enableDamping = !calm.matches;
  };
  controls.dampingFactor = 0.12;
  controls.minDistance = NEAREST_M;
  controls.maxDistance = FARTHEST_M;
  controls.maxPolarAngle = LOWEST_RAD;
  controls.enableZoom = false;
  // A finger that moves up or down scrolls the page, as everywhere else on it.
  canvas.style.touchAction = "pan-y";
  // The wheel scrolls the page too, until somebody has begun to look round here.
  const zoomWhileFocused = ({ type }: Event) => {
    controls.enableZoom = type === "focus";
  };
  const keepNear = () => {
    controls.target.clamp(
      new Vector3(home.x - PAN_LIMIT_M, home.y - PAN_LIMIT_M, 0),
      new Vector3(home.x + PAN_LIMIT_M, home.y + PAN_LIMIT_M, 1.6),
    );
    changed();
  };
  controls.addEventListener("change", keepNear);
  canvas.addEventListener("focus", zoomWhileFocused);
  canvas.addEventListener("blur", zoomWhileFocused);
  calm.addEventListener("change", heed);
  heed();

  let room = 1;
  let touched = false;
  controls.addEventListener("start", () => {
    touched = true;
  });

  const place = (distance: number, azimuth: number, polar: number) => {
    const far = MathUtils.clamp(distance, NEAREST_M, FARTHEST_M);
    const steep = MathUtils.clamp(polar, 0.05, LOWEST_RAD);
    camera.position
      .set(Math.sin(steep) * Math.cos(azimuth), Math.sin(steep) * Math.sin(azimuth), Math.cos(steep))
      .multiplyScalar(far)
      .add(controls.target);
    camera.lookAt(controls.target);
    changed();
  };
  const from = () => {
    const { x, y, z } = camera.position.clone().sub(controls.target);
    const distance = Math.hypot(x, y, z);
    return { distance, azimuth: Math.atan2(y, x), polar: Math.acos(z / distance) };
  };
  const reset = () => {
    touched = false;
    controls.target.copy(home);
    place(2.15 * room, 0.62, 1.02);
  };
  reset();

  return {
    reset,
    lookAt(target) {
      home.copy(target);
      reset();
    },
    turn(azimuth, polar) {
      touched = true;
      const now = from();
      place(now.distance, now.azimuth + azimuth * STEP_RAD, now.polar + polar * STEP_RAD);
    },
    zoom(nearer) {
      touched = true;
      const now = from();
      place(now.distance * (nearer ? ZOOM_STEP : 1 / ZOOM_STEP), now.azimuth, now.polar);
    },
    fit(aspect) {
      room = Math.min(Math.max(1, 1.45 / aspect), 2);
      if (!touched) reset();
    },
    update: () => controls.update(),
    dispose() {
      calm.removeEventListener("change", heed);
      canvas.removeEventListener("focus", zoomWhileFocused);
      canvas.removeEventListener("blur", zoomWhileFocused);
      controls.dispose();
    },
  };
}

// The stage of the 3-D scene: renderer, light, ground and camera, drawing only when there is reason to.
import {
  CircleGeometry,
  DirectionalLight,
  HemisphereLight,
  LineSegments,
  LineBasicMaterial,
  Mesh,
  MeshLambertMaterial,
  BufferGeometry,
  Float32BufferAttribute,
  Fog,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  WebGLRenderer,
} from "three";
import { createOrbit, type Orbit } from "./orbit";
import { createPace } from "./pace";
import type { Palette } from "./palette";
import { release } from "./release";

const HIGHEST_PIXEL_RATIO = 2;
/** After so long without motion a picture that was drawn coarsely is drawn once more, and sharp. */
const AT_REST_MS = 300;
const GROUND_M = 8;
const GRID_STEP_M = 0.5;

export interface Stage {
  readonly scene: Scene;
  readonly camera: PerspectiveCamera;
  readonly orbit: Orbit;
  /** Draw again soon. */
  invalidate(): void;
  paint(palette: Palette): void;
  dispose(): void;
}

/** What happens before each drawing; true asks for another one right after it. */
export type Before = (now: number) => boolean;

/** Throws where the browser has no WebGL. */
export function createStage(canvas: HTMLCanvasElement, before: Before, after: () => void): Stage {
  const bySoftware = drawsBySoftware();
  // Smooth edges take half of the time there is, where no graphics processor makes them.
  const renderer = new WebGLRenderer({ canvas, antialias: !bySoftware, powerPreference: "low-power" });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  const scene = new Scene();
  const camera = new PerspectiveCamera(38, 1, 0.05, 30);
  const ground = createGround();
  const grid = createGrid();
  const [ambient, key] = createLights();
  scene.add(ground, grid, ambient, key, key.target);

  const pace = createPace(bySoftware);
  let request = 0;
  let { pixels } = pace.first;
  /** The share of the device's pixels that the picture has now. */
  let share = pixels;
  let rest = 0;
  key.castShadow = pace.first.shadows;
  const draw = (now: number) => {
    request = 0;
    window.clearTimeout(rest);
    if (pace.early(now)) {
      invalidate();
      return;
    }
    if (share !== pixels) resize(pixels);
    const again = before(now);
    const turning = orbit.update();
    renderer.render(scene, camera);
    after();
    const less = pace.drawn(now);
    if (less !== null) {
      pixels = less.pixels;
      key.castShadow = less.shadows;
    }
    if (again || turning || less !== null) invalidate();
    else if (pixels < 1) rest = window.setTimeout(sharpen, AT_REST_MS);
  };
  const sharpen = () => {
    resize(1);
    renderer.render(scene, camera);
  };
  const invalidate = () => {
    if (request === 0) request = requestAnimationFrame(draw);
  };
  const orbit = createOrbit(camera, canvas, invalidate);

  /** Take another share of the device's pixels; what was drawn is gone with it. */
  const resize = (next: number) => {
    share = next;
    renderer.setPixelRatio(share * Math.min(devicePixelRatio, HIGHEST_PIXEL_RATIO));
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
  };
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) return;
    resize(pixels);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    orbit.fit(camera.aspect);
    invalidate();
  };
  const observer = new ResizeObserver(fit);
  observer.observe(canvas);
  canvas.addEventListener("webglcontextrestored", invalidate);
  fit();

  return {
    scene,
    camera,
    orbit,
    invalidate,
    paint(palette) {
      renderer.setClearColor(palette.ground);
      scene.fog = new Fog(palette.ground, 3.5, GROUND_M);
      ground.material.color.copy(palette.ground);
      grid.material.color.copy(palette.grid);
      invalidate();
    },
    dispose() {
      cancelAnimationFrame(request);
      window.clearTimeout(rest);
      observer.disconnect();
      canvas.removeEventListener("webglcontextrestored", invalidate);
      orbit.dispose();
      release(scene);
      renderer.dispose();
    },
  };
}

// Whoever draws says so in its name; `failIfMajorPerformanceCaveat` does not tell in all browsers.
const BY_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function drawsBySoftware(): boolean {
  const probe = document.createElement("canvas").getContext("webgl2");
  const named = probe?.getExtension("WEBGL_debug_renderer_info") ?? null;
  const renderer = named === null ? "" : String(probe?.getParameter(named.UNMASKED_RENDERER_WEBGL));
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return BY_SOFTWARE.test(renderer);
}

function createLights() {
  const ambient = new HemisphereLight(0xffffff, 0xb8bcc4, 2.1);
  ambient.position.set(0, 0, 1);
  const key = new DirectionalLight(0xffffff, 1.5);
  key.position.set(1.2, 1.6, 3.4);
  key.target.position.set(0.5, -0.1, 0.5);
  key.shadow.mapSize.set(1024, 1024);
  key.shadow.radius = 4;
  key.shadow.bias = -0.0005;
  key.shadow.normalBias = 0.01;
  const { camera } = key.shadow;
  [camera.left, camera.right, camera.bottom, camera.top] = [-1.6, 1.6, -1.6, 1.6];
  [camera.near, camera.far] = [0.5, 7];
  return [ambient, key] as const;
}

function createGround() {
  const ground = new Mesh(new CircleGeometry(GROUND_M, 48), new MeshLambertMaterial());
  ground.receiveShadow = true;
  return ground;
}

function createGrid() {
  const ends: number[] = [];
  for (let at = -4; at <= 4; at += GRID_STEP_M) ends.push(at, -4, 0.002, at, 4, 0.002, -4, at, 0.002, 4, at, 0.002);
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(ends, 3));
  return new LineSegments(geometry, new LineBasicMaterial());
}

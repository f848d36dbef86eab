// The 3-D picture itself with what lies over it: names, camera buttons, and pointing by hand and key.
import { useEffect, useRef, useState } from "preact/hooks";
import { effect } from "@preact/signals";
import type { Layout } from "../../wire/types";
import { theme } from "../../state/preferences";
import { CameraButtons } from "./camera_buttons";
import { createNames } from "./names";
import { withoutRun } from "../../tree/words";
import { plain } from "./interventions";
import { handlePointer } from "./pointer";
import type { Poses, Pointed, SceneView } from "./scene_view";
import { t } from "../../words/words";

interface Props {
  layout: Layout;
  poses: Poses & { onChange(listener: () => void): void };
  /** The object that is pointed at, here or elsewhere; its outline and name are shown. */
  pointed: string | null;
  /** Whether a click chooses a spot on the table. */
  choosing: boolean;
  /** Who of the people is doing something with an object: named beside it. */
  doers: ReadonlyMap<string, string>;
  onPoint(name: string | null): void;
  /** Somebody clicked, tapped or pressed Enter on something, at a spot of the picture. */
  onChoose(pointed: Pointed, at: { x: number; y: number }): void;
  /** There is no WebGL, or its code could not be loaded. */
  onFailure(sentence: string): void;
  onNote(sentence: string): void;
  children?: preact.ComponentChildren;
}

const HINT = t(
  "3-D view of the robot and the objects. Arrow keys turn it, plus and minus zoom, Home resets it; Page Up and Page Down choose an object, Enter opens its menu.",
);

export function SceneCanvas(props: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const overlay = useRef<HTMLDivElement>(null);
  const latest = useRef(props);
  const [view, setView] = useState<SceneView | null>(null);
  const [names, setNames] = useState(false);
  const named = useRef(names);
  latest.current = props;
  named.current = names;

  useEffect(() => {
    let made: SceneView | null = null;
    let gone = false;
    const host = overlay.current as HTMLElement;
    const marks = createNames(host, () => [...(host.parentElement?.querySelectorAll<HTMLElement>(".scene-tools") ?? [])]);
    const shownName = (name: string) => {
      const { doers, pointed, layout } = latest.current;
      if (name === layout.robot || layout.arms.some((each) => each.robot === name)) return withoutRun(name);
      const doer = doers.get(name);
      if (doer !== undefined) return `${plain(name)} · ${doer}`;
      return named.current || name === pointed ? plain(name) : null;
    };
    const make = async () => {
      const { createSceneView } = await import("./scene_view");
      if (gone || canvas.current === null) return;
      if (!hasWebGL()) throw new NoWebGL();
      const { layout, poses } = latest.current;
      const modelMissing = () => latest.current.onNote(t("The robot’s model could not be loaded; its gripper stands for it."));
      made = createSceneView(
        canvas.current,
        layout,
        poses,
        (spots) => marks.show(spots, shownName),
        modelMissing,
      );
      poses.onChange(made.invalidate);
      setView(made);
    };
    make().catch((error: unknown) => {
      if (!gone) latest.current.onFailure(error instanceof NoWebGL ? NO_WEBGL : NOT_LOADED);
    });
    return () => {
      gone = true;
      latest.current.poses.onChange(() => {});
      made?.dispose();
      overlay.current?.replaceChildren();
    };
  }, [props.layout]);

  useEffect(() => view?.highlight(props.pointed), [view, props.pointed]);
  useEffect(() => view?.invalidate(), [view, names, props.doers]);
  useEffect(() => {
    if (view === null) return;
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", view.repaint);
    const stop = effect(() => {
      void theme.value;
      // The attribute that decides the colours is set by another effect on the same signal.
      queueMicrotask(view.repaint);
    });
    return () => {
      dark.removeEventListener("change", view.repaint);
      stop();
    };
  }, [view]);
  useEffect(() => {
    if (view === null || canvas.current === null) return;
    return handlePointer(canvas.current, view, {
      pointed: (what) => latest.current.onPoint(what?.kind === "object" ? what.name : null),
      chosen: (what, at) => latest.current.onChoose(what, at),
    });
  }, [view]);

  const onKeyDown = (event: KeyboardEvent) => {
    if (view !== null && handleKey(event.key, view, props)) event.preventDefault();
  };
  return (
    <div class={props.choosing ? "scene-view choosing" : "scene-view"}>
      <canvas
        ref={canvas}
        class="scene-canvas"
        tabIndex={0}
        role="application"
        aria-label={HINT}
        data-drawn={view !== null}
        onKeyDown={onKeyDown}
      />
      <div ref={overlay} class="scene-names" aria-hidden="true" />
      <CameraButtons view={view} names={names} onNames={setNames} />
      {props.children}
    </div>
  );
}

class NoWebGL extends Error {}

const NO_WEBGL = t("This browser cannot draw in 3-D (it has no WebGL), so the cameras have to do.");
const NOT_LOADED = t("The 3-D view could not be loaded, so the cameras have to do.");

function hasWebGL(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}

function handleKey(key: string, view: SceneView, { layout, pointed, onPoint, onChoose }: Props): boolean {
  switch (key) {
    case "ArrowLeft":
      view.turn(-1, 0);
      return true;
    case "ArrowRight":
      view.turn(1, 0);
      return true;
    case "ArrowUp":
      view.turn(0, -1);
      return true;
    case "ArrowDown":
      view.turn(0, 1);
      return true;
    case "+":
    case "=":
      view.zoom(true);
      return true;
    case "-":
      view.zoom(false);
      return true;
    case "Home":
      view.resetCamera();
      return true;
    case "PageDown":
    case "PageUp":
      onPoint(neighbour(layout, pointed, key === "PageDown" ? 1 : -1));
      return true;
    case "Enter": {
      const at = view.spotOf(pointed) ?? { x: 0, y: 0 };
      onChoose(pointed === null ? { kind: "arm" } : { kind: "object", name: pointed }, at);
      return true;
    }
    default:
      return false;
  }
}

function neighbour({ objects }: Layout, pointed: string | null, step: 1 | -1): string | null {
  const names = objects.filter((each) => each.kind === "object").map((each) => each.name);
  const at = pointed === null ? (step === 1 ? -1 : 0) : names.indexOf(pointed);
  return names.at((at + step) % names.length) ?? null;
}

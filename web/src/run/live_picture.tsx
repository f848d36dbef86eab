// One camera of a run, live: a picture after the other for as long as anybody sees them.
import { useComputed } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { Detection } from "../wire/types";
import { t } from "../words/words";

const EVERY_MS = 300;
const AFTER_REFUSAL_MS = 2_000;
const GONE = 404;

export interface Camera {
  readonly run: string;
  readonly camera: string;
  /** Which robot's; the first that has such a camera without it. */
  readonly robot?: string | undefined;
}

export interface Live {
  /** The address of the newest picture; null while there is none. */
  readonly picture: string | null;
  /** Where in it the robot looks for what it looks for. */
  readonly detection: Detection | null;
  /** Why there is none. */
  readonly reason: string;
}

const NOTHING_YET: Live = { picture: null, detection: null, reason: t("Waiting for a picture …") };

/** The pictures of a camera while the element that shows them can be seen. */
export function useLivePicture({ run, camera, robot }: Camera) {
  const frame = useRef<HTMLDivElement>(null);
  const [live, setLive] = useState<Live>(NOTHING_YET);
  const connected = useComputed(() => connection.value === "connected").value;
  useEffect(() => {
    if (!connected || frame.current === null) return;
    let shown: string | null = null;
    const show = (next: rest.CameraPicture | null, reason: string) => {
      if (shown !== null) URL.revokeObjectURL(shown);
      shown = next === null ? null : URL.createObjectURL(next.blob);
      setLive({ picture: shown, detection: next?.detection ?? null, reason });
    };
    const stop = whileVisible(frame.current, () => follow({ run, camera, robot }, show));
    return () => {
      stop();
      show(null, NOTHING_YET.reason);
    };
  }, [run, camera, robot, connected]);
  return { frame, live: connected ? live : { ...NOTHING_YET, reason: t("No picture: the connection is lost.") } };
}

/** Ask for one picture after the other until stopped; none is asked for before the last one has come. */
function follow({ run, camera, robot }: Camera, show: (picture: rest.CameraPicture | null, reason: string) => void) {
  let stopped = false;
  let timer = 0;
  const ask = async () => {
    let pause = EVERY_MS;
    try {
      const picture = await rest.cameraPicture(run, camera, robot);
      if (!stopped) show(picture, "");
    } catch (error) {
      pause = AFTER_REFUSAL_MS;
      if (!stopped) show(null, sentenceOn(error));
    }
    if (!stopped) timer = window.setTimeout(() => void ask(), pause);
  };
  void ask();
  return () => {
    stopped = true;
    window.clearTimeout(timer);
  };
}

function sentenceOn(error: unknown): string {
  if (error instanceof rest.Refusal && error.status === GONE) return t("No picture: the robot is not there yet, or has no such camera.");
  return t("The robot sends no picture now.");
}

/** Do something as long as an element can be seen; returns how to stop for good. */
function whileVisible(element: Element, begin: () => () => void): () => void {
  let inView = false;
  let stop: (() => void) | null = null;
  const heed = () => {
    const seen = inView && document.visibilityState === "visible";
    if (seen) stop ??= begin();
    else {
      stop?.();
      stop = null;
    }
  };
  const observer = new IntersectionObserver((entries) => {
    inView = entries.at(-1)?.isIntersecting ?? false;
    heed();
  });
  observer.observe(element);
  document.addEventListener("visibilitychange", heed);
  return () => {
    observer.disconnect();
    document.removeEventListener("visibilitychange", heed);
    stop?.();
  };
}

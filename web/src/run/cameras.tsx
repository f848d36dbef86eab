// What the robot's cameras see: live while the run goes on, else what is kept of the moment shown.
import { useComputed } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { connection, onEvent } from "../state/service";
import * as rest from "../wire/rest";
import type { RunStatus } from "../wire/types";
import { type KeptPicture, keptPictures, pictureNear } from "./camera_record";
import type { Moment } from "./moment";
import "./cameras.css";

const CAMERAS = [
  ["head", "Head camera"],
  ["forearm", "Forearm camera"],
] as const;

const EVERY_MS = 300;
const AFTER_REFUSAL_MS = 2_000;
const GONE = 404;

interface Props {
  run: string;
  moment: Moment;
  status: RunStatus | null;
}

export function Cameras({ run, moment, status }: Props) {
  const kept = useKeptPictures(run);
  const goesOn = status === "running" || status === "paused";
  return (
    <section class="panel cameras" aria-labelledby="cameras-title">
      <h2 id="cameras-title">Cameras</h2>
      <div class="cameras-both">
        {CAMERAS.map(([camera, title]) => (
          <figure key={camera} class="camera">
            {goesOn && moment.live.value ? (
              <LivePicture run={run} camera={camera} title={title} />
            ) : (
              <PastPicture kept={kept} camera={camera} title={title} moment={moment} />
            )}
            <figcaption>{title}</figcaption>
          </figure>
        ))}
      </div>
    </section>
  );
}

/** Those that the run's journal has, and each new one as it comes. */
function useKeptPictures(run: string): readonly KeptPicture[] {
  const [kept, setKept] = useState<readonly KeptPicture[]>([]);
  useEffect(() => {
    let gone = false;
    const stop = onEvent((event) => {
      const more = event.run === run ? keptPictures([event]) : [];
      if (more.length > 0) setKept((before) => [...before, ...more]);
    });
    rest.events(run).then(
      (events) => {
        if (!gone) setKept(keptPictures(events));
      },
      // The run view says that the run cannot be read.
      () => {},
    );
    return () => {
      gone = true;
      stop();
    };
  }, [run]);
  return kept;
}

function PastPicture(props: { kept: readonly KeptPicture[]; camera: string; title: string; moment: Moment }) {
  const { kept, camera, title, moment } = props;
  const nearest = pictureNear(kept, camera, moment.time.value);
  if (nearest === null) {
    return <p class="camera-none">No picture is kept of this moment. Those of a fault and the seconds before it are.</p>;
  }
  return (
    <>
      <img src={rest.picturePath(nearest.picture)} alt={`${title} at ${nearest.time.toFixed(1)} s`} />
      <p class="camera-when small">{nearest.time.toFixed(1)} s</p>
    </>
  );
}

function LivePicture({ run, camera, title }: { run: string; camera: string; title: string }) {
  const frame = useRef<HTMLDivElement>(null);
  const [picture, setPicture] = useState<string | null>(null);
  const [reason, setReason] = useState("");
  const connected = useComputed(() => connection.value === "connected").value;
  useEffect(() => {
    if (!connected || frame.current === null) return;
    let shown: string | null = null;
    const show = (next: Blob | null) => {
      if (shown !== null) URL.revokeObjectURL(shown);
      shown = next === null ? null : URL.createObjectURL(next);
      setPicture(shown);
    };
    const stop = whileVisible(frame.current, () =>
      follow(run, camera, show, (sentence) => {
        show(null);
        setReason(sentence);
      }),
    );
    return () => {
      stop();
      show(null);
    };
  }, [run, camera, connected]);
  return (
    <div ref={frame} class="camera-frame">
      {picture === null ? (
        <p class="camera-none">{connected ? reason || "Waiting for a picture …" : "No picture: the connection is lost."}</p>
      ) : (
        <img src={picture} alt={`${title}, live`} />
      )}
    </div>
  );
}

/** Ask for one picture after the other until stopped; none is asked for before the last one has come. */
function follow(run: string, camera: string, show: (picture: Blob) => void, missing: (why: string) => void) {
  let stopped = false;
  let timer = 0;
  const ask = async () => {
    let pause = EVERY_MS;
    try {
      const picture = await rest.cameraPicture(run, camera);
      if (!stopped) show(picture);
    } catch (error) {
      pause = AFTER_REFUSAL_MS;
      if (!stopped) missing(sentenceOn(error));
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
  if (error instanceof rest.Refusal && error.status === GONE) return "No picture: the robot is not there yet, or has no such camera.";
  return "The robot sends no picture now.";
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

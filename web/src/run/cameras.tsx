// What the robot's cameras see: live while the run goes on, else what is kept of the moment shown.
import { useEffect, useState } from "preact/hooks";
import { onEvent } from "../state/service";
import * as rest from "../wire/rest";
import type { RunStatus } from "../wire/types";
import { type KeptPicture, keptPictures, ownerOf, pictureNear } from "./camera_record";
import { RecordButton } from "./record_button";
import { useLivePicture } from "./live_picture";
import type { Moment } from "./moment";
import { decimal, t } from "../words/words";
import "./cameras.css";

const CAMERAS = [
  ["head", t("Head camera")],
  ["forearm", t("Forearm camera")],
] as const;

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
      <h2 id="cameras-title">{t("Cameras")}</h2>
      {goesOn && <RecordButton key={run} run={run} />}
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
    return (
      <p class="camera-none">
        {t("No picture is kept of this moment. Those around faults are, and what somebody had recorded.")}
      </p>
    );
  }
  const owner = ownerOf(kept, nearest);
  return (
    <>
      <img src={rest.picturePath(nearest.picture)} alt={t("{title} at {time} s", { title, time: decimal(nearest.time, 1) })} />
      <p class="camera-when small">
        {decimal(nearest.time, 1)} s{owner !== null && ` · ${owner}`}
      </p>
    </>
  );
}

function LivePicture({ run, camera, title }: { run: string; camera: string; title: string }) {
  const { frame, live } = useLivePicture({ run, camera });
  return (
    <div ref={frame} class="camera-frame">
      {live.picture === null ? (
        <p class="camera-none">{live.reason}</p>
      ) : (
        <img src={live.picture} alt={t("{title}, live", { title })} />
      )}
    </div>
  );
}

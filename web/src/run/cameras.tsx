// What the robot's cameras see: live while the run goes on, else what is kept of the moment shown.
import { useEffect, useState } from "preact/hooks";
import { robots } from "../state/robots";
import { onEvent } from "../state/service";
import { plain, withoutRun } from "../tree/words";
import * as rest from "../wire/rest";
import type { RunStatus } from "../wire/types";
import { CameraLarge } from "./camera_large";
import { camerasOf, type KeptPicture, keptPictures, ownerOf, pictureNear } from "./camera_record";
import { RecordButton } from "./record_button";
import { useLivePicture } from "./live_picture";
import type { Moment } from "./moment";
import { decimal, t } from "../words/words";
import "./cameras.css";

const TITLES: Readonly<Record<string, string>> = {
  head: t("Head camera"),
  forearm: t("Forearm camera"),
};

interface Props {
  run: string;
  /** The run's robots. */
  robots: readonly string[];
  moment: Moment;
  status: RunStatus | null;
}

export function Cameras({ run, robots: ofRun, moment, status }: Props) {
  const kept = useKeptPictures(run);
  const [chosen, setChosen] = useState<string | null>(null);
  const [large, setLarge] = useState<string | null>(null);
  const goesOn = status === "running" || status === "paused";
  const robot = ofRun.length > 1 ? (chosen ?? ofRun[0]) : undefined;
  const there = robots.value.find((each) => each.robot === (robot ?? ofRun[0]))?.cameras ?? [];
  const picture = (camera: string) => {
    const what = { camera, title: titleOf(camera) };
    return goesOn && moment.live.value ? (
      <LivePicture key={robot} run={run} robot={robot} {...what} />
    ) : (
      <PastPicture kept={robot === undefined ? kept : kept.filter((each) => each.robot === robot)} moment={moment} {...what} />
    );
  };
  return (
    <section class="panel cameras" aria-labelledby="cameras-title">
      <h2 id="cameras-title">{t("Cameras")}</h2>
      {robot !== undefined && (
        <select aria-label={t("Whose cameras")} value={robot} onChange={(event) => setChosen(event.currentTarget.value)}>
          {ofRun.map((each) => (
            <option key={each} value={each}>
              {withoutRun(each)}
            </option>
          ))}
        </select>
      )}
      {goesOn && <RecordButton key={run} run={run} />}
      <div class="cameras-both">
        {camerasOf(there, kept).map((camera) => (
          <figure key={camera} class="camera">
            {picture(camera)}
            <figcaption>
              {titleOf(camera)}
              <button type="button" class="small-button" aria-label={t("Enlarge: {title}", { title: titleOf(camera) })} onClick={() => setLarge(camera)}>
                {t("Enlarge")}
              </button>
            </figcaption>
          </figure>
        ))}
      </div>
      {large !== null && (
        <CameraLarge title={titleOf(large)} onClose={() => setLarge(null)}>
          {picture(large)}
        </CameraLarge>
      )}
    </section>
  );
}

function titleOf(camera: string): string {
  return TITLES[camera] ?? plain(camera);
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

function LivePicture({ run, robot, camera, title }: { run: string; robot: string | undefined; camera: string; title: string }) {
  const { frame, live } = useLivePicture({ run, robot, camera });
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

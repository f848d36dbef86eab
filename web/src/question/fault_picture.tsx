// What the robot saw at the moment of the fault, and the seconds before it.
import { useEffect, useState } from "preact/hooks";
import type { Question } from "../state/questions";
import { picturePath } from "../wire/rest";
import { ClipControls } from "./clip_controls";
import { cameraWord, spoken } from "./fault_words";
import { SeenPicture } from "./seen_picture";
import { t } from "../words/words";
import { Told } from "../words/told";

/** The fault, or, once promised help was not seen, what the camera showed then. */
export function WhatWasSeen({ question }: { question: Question }) {
  const { unseen_help } = question;
  if (unseen_help === null) return <FaultPicture question={question} />;
  const { picture, detection } = unseen_help;
  const camera = detection?.camera ?? "head";
  return (
    <figure class="fault">
      <SeenPicture
        source={picturePath(picture)}
        alt={t("What the robot's {camera} camera saw when it last looked", { camera: cameraWord(camera) })}
        detection={detection}
        moment={t("When I last looked")}
      />
      <figcaption class="small quiet">{t("{camera} camera", { camera: cameraWord(camera) })}</figcaption>
    </figure>
  );
}

function FaultPicture({ question }: { question: Question }) {
  const { clip, detection, picture } = question;
  // Frames count from the clip's first picture; the one after its last is the fault itself.
  const [frame, setFrame] = useState<number | null>(null);
  const earlier = frame === null ? undefined : clip[frame];
  const shown = earlier?.picture ?? picture ?? clip.at(-1)?.picture;
  useEffect(() => setFrame(null), [question.dialogue]);
  if (shown === undefined || shown === null) return null;
  const camera = earlier !== undefined ? "forearm" : (detection?.camera ?? "forearm");
  return (
    <figure class="fault">
      <SeenPicture
        source={picturePath(shown)}
        alt={t("What the robot's {camera} camera saw", { camera: cameraWord(camera) })}
        size={detection?.size_px ?? null}
        detection={earlier === undefined ? detection : null}
        moment={earlier === undefined ? t("At the fault") : t("Before the fault")}
      />
      {clip.length > 0 && <ClipControls question={question} frame={frame} onFrame={setFrame} />}
      <figcaption class="small quiet">
        {t("{camera} camera", { camera: cameraWord(camera) })}
        {detection !== null && detection.explanation !== "" && (
          <>
            {detection.felt ? t(". Felt: ") : ": "}
            <Told text={spoken(detection.explanation)} />.
          </>
        )}
      </figcaption>
    </figure>
  );
}

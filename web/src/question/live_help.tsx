// The camera now, with what is looked for outlined, while help is awaited.
import { useLivePicture } from "../run/live_picture";
import type { Question } from "../state/questions";
import type { Detection } from "../wire/types";
import { cameraWord } from "./fault_words";
import { SeenPicture } from "./seen_picture";
import { t } from "../words/words";

export function LiveHelp({ question, camera }: { question: Question; camera: string }) {
  const { frame, live } = useLivePicture({ run: question.run, camera, robot: question.robot });
  return (
    <figure class="fault help-camera">
      <div ref={frame}>
        {live.picture === null ? (
          <p class="quiet small">{live.reason}</p>
        ) : (
          <SeenPicture
            source={live.picture}
            alt={t("What the robot's {camera} camera sees now", { camera: cameraWord(camera) })}
            detection={live.detection ?? whereItIsToBe(question, camera)}
            moment={t("Now")}
          />
        )}
      </div>
    </figure>
  );
}

/** As the last look told it: where a thing is to be does not change, where it was seen may have. */
function whereItIsToBe({ unseen_help }: Question, camera: string): Detection | null {
  const told = unseen_help?.detection ?? null;
  return told === null || told.camera !== camera ? null : { ...told, center: null };
}

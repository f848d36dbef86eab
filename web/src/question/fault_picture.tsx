// What the robot saw at the moment of the fault, and the seconds before it.
import { useEffect, useState } from "preact/hooks";
import type { Question } from "../state/questions";
import { picturePath } from "../wire/rest";
import { ClipControls } from "./clip_controls";
import { DetectionOverlay } from "./detection_overlay";
import { spoken } from "./fault_words";
import "./fault_picture.css";

export function FaultPicture({ question }: { question: Question }) {
  const { clip, detection, picture } = question;
  // Frames count from the clip's first picture; the one after its last is the fault itself.
  const [frame, setFrame] = useState<number | null>(null);
  const [size, setSize] = useState<{ width: number; height: number } | null>(null);
  const earlier = frame === null ? undefined : clip[frame];
  const shown = earlier?.picture ?? picture ?? clip.at(-1)?.picture;
  useEffect(() => setFrame(null), [question.dialogue]);
  if (shown === undefined || shown === null) return null;
  const camera = earlier !== undefined ? "forearm" : (detection?.camera ?? "forearm");
  const measure = (event: Event) => {
    const { naturalWidth: width, naturalHeight: height } = event.currentTarget as HTMLImageElement;
    setSize({ width, height });
  };
  return (
    <figure class="fault">
      <div class="fault-picture">
        <img
          src={picturePath(shown)}
          alt={`What the robot's ${camera} camera saw`}
          // Room for it before it is there, so that nothing moves away from under a finger.
          width={detection?.size_px?.[0]}
          height={detection?.size_px?.[1]}
          onLoad={measure}
        />
        {earlier === undefined && detection !== null && size !== null && (
          <DetectionOverlay detection={detection} size={size} />
        )}
        <span class="fault-moment">{earlier === undefined ? "At the fault" : "Before the fault"}</span>
      </div>
      {clip.length > 0 && <ClipControls question={question} frame={frame} onFrame={setFrame} />}
      <figcaption class="small quiet">
        {spoken(camera)} camera
        {detection !== null && detection.explanation !== "" && (
          <>
            {detection.felt ? ". Felt: " : ": "}
            {spoken(detection.explanation)}.
          </>
        )}
      </figcaption>
    </figure>
  );
}

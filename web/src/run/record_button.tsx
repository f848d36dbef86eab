// Having the cameras recorded for a while, for who wants to see later what happens now.
import { useEffect, useState } from "preact/hooks";
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import * as rest from "../wire/rest";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

const CHOICES_S = [10, 30, 60] as const;

export function RecordButton({ run }: { run: string }) {
  const [seconds, setSeconds] = useState<number>(CHOICES_S[0]);
  const [recording, setRecording] = useState(false);
  const [note, setNote] = useState("");
  useEffect(() => {
    if (!recording) return;
    const timer = window.setTimeout(() => {
      setRecording(false);
      setNote(t("The time is over. What the cameras gave is in the replay."));
    }, seconds * 1000);
    return () => window.clearTimeout(timer);
  }, [recording]);
  if (!may("operator")) return null;
  const record = async () => {
    setNote("");
    try {
      await rest.recordCameras(run, { seconds, helper: helperName.value });
      setRecording(true);
    } catch (error) {
      setNote(whyNotDone(error));
    }
  };
  return (
    <div class="camera-recording">
      <button class="button" type="button" disabled={recording} onClick={() => void record()}>
        {recording ? t("Recording …") : t("Record")}
      </button>
      <label class="small">
        <span class="unseen">{t("For how long")}</span>
        <select
          class="input"
          value={seconds}
          disabled={recording}
          onChange={(event) => setSeconds(Number(event.currentTarget.value))}
        >
          {CHOICES_S.map((each) => (
            <option key={each} value={each}>
              {each} s
            </option>
          ))}
        </select>
      </label>
      <span role="status" class="small quiet">
        {note}
      </span>
    </div>
  );
}

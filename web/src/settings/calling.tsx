// How this device calls its helper.
import { useState } from "preact/hooks";
import { besideRobot, pushOn, soundOn } from "../state/preferences";
import { callThisDevice, callThisDeviceNoMore, whyNoPush } from "../calling/push";
import { may } from "../state/access";
import { CallTest } from "./call_test";
import { Notifications } from "./notifications";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

export function Calling() {
  return (
    <section class="panel setting-group" aria-labelledby="calling-title">
      <h2 id="calling-title">{t("When a robot asks")}</h2>
      <label class="choice">
        <input
          type="checkbox"
          checked={soundOn.value}
          onChange={(event) => {
            soundOn.value = event.currentTarget.checked;
          }}
        />
        {t("Call by sound, again and again until somebody is on it")}
      </label>
      {may("helper") && <CallDevice />}
      <Notifications />
      <label class="choice">
        <input
          type="checkbox"
          checked={besideRobot.value}
          aria-describedby="beside-hint"
          onChange={(event) => {
            besideRobot.value = event.currentTarget.checked;
          }}
        />
        {t("This device stands beside the robot")}
      </label>
      <p id="beside-hint" class="small quiet">
        {t("Its screen stays on, questions are spoken, and it listens for answers from the start.")}
      </p>
      <CallTest />
    </section>
  );
}

/** Calls also while no page is open, by web push. */
function CallDevice() {
  const why = whyNoPush();
  const [mistake, setMistake] = useState("");
  /** What is being done now; null for nothing. */
  const [wanted, setWanted] = useState<boolean | null>(null);
  const change = async (want: boolean) => {
    setWanted(want);
    setMistake("");
    try {
      await (want ? callThisDevice() : callThisDeviceNoMore());
    } catch (error) {
      setMistake(whyNotDone(error));
    }
    setWanted(null);
  };
  return (
    <>
      <label class="choice">
        <input
          type="checkbox"
          checked={wanted ?? pushOn.value}
          disabled={wanted !== null || (why !== null && !pushOn.value)}
          aria-describedby="push-hint"
          onChange={(event) => void change(event.currentTarget.checked)}
        />
        {t("Call this device also while this page is closed")}
      </label>
      <p id="push-hint" class={mistake === "" ? "small quiet" : "small mistake"} role="status">
        {mistake !== "" ? mistake : (why ?? "")}
      </p>
    </>
  );
}

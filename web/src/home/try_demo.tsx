// Offers who has nothing yet a robot that asks.
import { useState } from "preact/hooks";
import { fleets } from "../requests/fleets";
import { may } from "../state/access";
import { robots } from "../state/robots";
import { refreshRuns, runs, runsRead } from "../state/service";
import * as rest from "../wire/rest";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import { DEMO, offersDemo } from "./demo";

export function TryDemo() {
  const [starting, setStarting] = useState(false);
  const [mistake, setMistake] = useState("");
  const there = { runs: runs.value.values(), robots: robots.value, fleets: fleets.value?.length ?? 0 };
  if (!may("operator") || !runsRead.value || !offersDemo(there)) return null;
  const start = async () => {
    setStarting(true);
    setMistake("");
    try {
      await rest.startRun(DEMO);
      await refreshRuns();
    } catch (error) {
      setMistake(whyNotDone(error));
    }
    setStarting(false);
  };
  return (
    <section class="panel home-demo" aria-labelledby="home-demo">
      <h2 id="home-demo">{t("New here?")}</h2>
      <p>{t("A simulated robot builds a small table, somebody takes its parts away, and it asks you here, in less than a minute.")}</p>
      <button type="button" class="button primary" disabled={starting} onClick={() => void start()}>
        {starting ? t("Starting …") : t("Try a demo")}
      </button>
      <p class="mistake" role="alert">
        {mistake}
      </p>
    </section>
  );
}

// The button that tries whether this device will really call, and what it has found.
import { useState } from "preact/hooks";
import { testCalling } from "../calling/call_test";
import { type Finding, type State, verdict } from "../calling/findings";
import { t } from "../words/words";
import "./call_test.css";

const SIGNS: Readonly<Record<State, { path: string; name: string }>> = {
  well: { path: "m5 10.5 3.5 3.5L15 7", name: t("Works") },
  bad: { path: "M10 4.5v7M10 14.5v1", name: t("Does not work") },
  unused: { path: "M6 10h8", name: t("Not known") },
};

export function CallTest() {
  const [findings, setFindings] = useState<readonly Finding[]>([]);
  const [state, setState] = useState<"idle" | "running" | "done">("idle");
  const begin = async () => {
    setState("running");
    setFindings([]);
    await testCalling((finding) => setFindings((before) => [...before, finding]));
    setState("done");
  };
  return (
    <div class="call-test">
      <p>
        <button type="button" class="button" disabled={state === "running"} onClick={() => void begin()}>
          {state === "running" ? t("Trying …") : t("Try whether this device calls me")}
        </button>
      </p>
      {findings.length > 0 && (
        <ul>
          {findings.map((each) => (
            <Line key={each.what} finding={each} />
          ))}
        </ul>
      )}
      <div role="status">{state === "done" && <Verdict finding={verdict(findings)} />}</div>
    </div>
  );
}

function Line({ finding: { what, state, words } }: { finding: Finding }) {
  return (
    <li class={state}>
      <Sign state={state} />
      <span>
        <strong>{what}:</strong> {words}
      </span>
    </li>
  );
}

function Verdict({ finding: { state, words } }: { finding: Finding }) {
  return (
    <p class={`call-verdict ${state}`}>
      <Sign state={state} />
      <strong>{words}</strong>
    </p>
  );
}

function Sign({ state }: { state: State }) {
  const { path, name } = SIGNS[state];
  return (
    <svg viewBox="0 0 20 20" width="20" height="20" role="img" aria-label={name}>
      <circle cx="10" cy="10" r="9" />
      <path d={path} />
    </svg>
  );
}

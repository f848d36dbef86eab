// Runs that are made here and now, with what the service says of them after every event.
import { execFileSync } from "node:child_process";

/** By the python of the environment that runs the tests (`make test`). */
export function foldedRuns(seeds) {
  const root = new URL("../../", import.meta.url).pathname;
  const lines = execFileSync("python", ["tests/doubles/folded_runs.py", ...seeds], {
    cwd: root,
    env: { ...process.env, PYTHONPATH: `${root}tests/doubles:${root}benchmarks` },
    encoding: "utf8",
    maxBuffer: 1 << 30,
  });
  return lines.trim().split("\n").map((line) => JSON.parse(line));
}

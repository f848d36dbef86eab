// All runs, newest first.
import { runs } from "../state/service";

export function RunsView() {
  const newest = [...runs.value.values()].sort((a, b) => b.started.localeCompare(a.started));
  return (
    <section class="page">
      <h1>Runs</h1>
      <ul>
        {newest.map((run) => (
          <li key={run.id}>
            <a href={`/runs/${run.id}`}>
              {run.tree} in {run.world}
            </a>{" "}
            <span class={`badge ${run.status}`}>{run.status}</span>
          </li>
        ))}
      </ul>
    </section>
  );
}

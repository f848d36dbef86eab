// The library of task trees.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import type { TreeSummary } from "../wire/types";

export function TreesView({ tree }: { tree: string | null }) {
  const [trees, setTrees] = useState<readonly TreeSummary[]>([]);
  useEffect(() => {
    void rest.trees().then(setTrees);
  }, []);
  return (
    <section class="page">
      <h1>Task trees</h1>
      <ul>
        {trees.map((each) => (
          <li key={each.name}>
            <a href={`/trees/${each.name}`} aria-current={each.name === tree ? "page" : undefined}>
              {each.name}
            </a>
          </li>
        ))}
      </ul>
    </section>
  );
}

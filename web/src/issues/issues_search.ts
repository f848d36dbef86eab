// What is searched for among the issues: kept while one looks at one and comes back, and set by links to them.
import { signal } from "@preact/signals";
import { ANYTHING, type Search } from "../run/search";

export const search = signal(ANYTHING);

/** After which issue each page begins; the newest has none. */
export const pages = signal<readonly (number | null)[]>([null]);

export function searchIssues(wanted: Search): void {
  search.value = wanted;
  pages.value = [null];
}

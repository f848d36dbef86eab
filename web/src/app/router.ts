// Which view the address names.
import { computed, signal } from "@preact/signals";

export type Route =
  | { view: "questions" }
  | { view: "runs" }
  | { view: "issues" }
  | { view: "statistics" }
  | { view: "run"; run: string }
  | { view: "trees" }
  | { view: "tree"; tree: string }
  | { view: "edit"; tree: string | null }
  | { view: "scenes" }
  | { view: "edit_scene"; scene: string | null }
  | { view: "models" }
  | { view: "start"; tree: string | null }
  | { view: "requests" }
  | { view: "touch"; robot: string }
  | { view: "fleet"; site: string | null }
  | { view: "settings" }
  | { view: "unknown"; path: string };

type Page = "runs" | "issues" | "statistics" | "trees" | "scenes" | "models" | "requests" | "settings";

const PAGES: ReadonlySet<Page> = new Set<Page>(["runs", "issues", "statistics", "trees", "scenes", "models", "requests", "settings"]);

const path = signal(settled());

export const route = computed(() => routeOf(path.value));

export function routeOf(address: string): Route {
  const [first = "", second, ...rest] = address.split("/").filter(Boolean).map(decodeURIComponent);
  if (first === "robots" && second !== undefined && rest.join("/") === "ask") return { view: "touch", robot: second };
  if (rest.length > 0) return { view: "unknown", path: address };
  if (second === undefined) {
    if (first === "") return { view: "questions" };
    if (PAGES.has(first as Page)) return { view: first as Page };
    if (first === "fleet") return { view: first, site: null };
    if (first === "edit" || first === "start") return { view: first, tree: null };
    if (first === "edit_scene") return { view: first, scene: null };
  } else if (first === "runs") return { view: "run", run: second };
  else if (first === "trees") return { view: "tree", tree: second };
  else if (first === "fleet") return { view: first, site: second };
  else if (first === "edit_scene") return { view: first, scene: second };
  else if (first === "edit" || first === "start") return { view: first, tree: second };
  return { view: "unknown", path: address };
}

/** The path of the address that is shown, which is put as it is kept. */
function settled(): string {
  const kept = keptAddress(location.pathname, location.search);
  if (kept !== location.pathname + location.search) history.replaceState(null, "", kept);
  return location.pathname;
}

/** An address as it is kept: the building of a fleet has one of its own, also where a link names it as `?site=`. */
export function keptAddress(path: string, search: string): string {
  const said = new URLSearchParams(search);
  const site = said.get("site");
  if (path !== "/fleet" || site === null || site === "") return path + search;
  said.delete("site");
  const rest = said.toString();
  return `/fleet/${encodeURIComponent(site)}${rest === "" ? "" : `?${rest}`}`;
}

/** Asked before the view is left: calls `leave` now or later, or never. */
type Guard = (leave: () => void) => void;

let guard: Guard | null = null;

/** Have `ask` decide whether this view may be left; returns how to lift that. */
export function guardLeaving(ask: Guard): () => void {
  guard = ask;
  return () => {
    if (guard === ask) guard = null;
  };
}

export function go(address: string): void {
  if (guard !== null && address !== path.value) guard(() => show(address));
  else show(address);
}

function show(address: string): void {
  guard = null;
  if (address !== location.pathname + location.search) history.pushState(null, "", address);
  path.value = settled();
}

addEventListener("popstate", () => {
  const address = settled();
  if (guard === null || address === path.value) {
    path.value = address;
    return;
  }
  // The browser has gone already: stay where one was until it is decided.
  history.pushState(null, "", path.value);
  guard(() => show(address));
});

/** Follow links inside the console without loading the page again. */
export function followLinks(root: Node): void {
  root.addEventListener("click", (event) => {
    const click = event as MouseEvent;
    const link = (click.target as Element).closest?.("a[href]");
    const plain = click.button === 0 && !click.ctrlKey && !click.metaKey && !click.shiftKey;
    if (!(link instanceof HTMLAnchorElement) || !plain || link.target || link.hasAttribute("download")) return;
    if (link.origin !== location.origin || link.pathname.startsWith("/api/") || link.pathname === "/docs") return;
    click.preventDefault();
    go(link.pathname + link.search);
  });
}

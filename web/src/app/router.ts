// Which view the address names.
import { computed, signal } from "@preact/signals";

export type Route =
  | { view: "questions" }
  | { view: "runs" }
  | { view: "run"; run: string }
  | { view: "trees" }
  | { view: "tree"; tree: string }
  | { view: "settings" }
  | { view: "unknown"; path: string };

const path = signal(location.pathname);

export const route = computed(() => routeOf(path.value));

export function routeOf(address: string): Route {
  const [first = "", second, ...rest] = address.split("/").filter(Boolean).map(decodeURIComponent);
  if (rest.length > 0) return { view: "unknown", path: address };
  if (second === undefined) {
    if (first === "") return { view: "questions" };
    if (first === "runs" || first === "trees" || first === "settings") return { view: first };
  } else if (first === "runs") return { view: "run", run: second };
  else if (first === "trees") return { view: "tree", tree: second };
  return { view: "unknown", path: address };
}

export function go(address: string): void {
  if (address !== location.pathname) history.pushState(null, "", address);
  path.value = location.pathname;
}

addEventListener("popstate", () => {
  path.value = location.pathname;
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
    go(link.pathname);
  });
}

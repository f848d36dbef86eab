// The bar on top: where to go, whether the service is there, who one is.
import type { ConnectionState } from "../wire/helper_socket";
import { fleets } from "../requests/fleets";
import { questions } from "../state/questions";
import { helperName } from "../state/preferences";
import { presence } from "../calling/presence";
import { connection } from "../state/service";
import { route } from "./router";
import { t } from "../words/words";

const CONNECTION: Readonly<Record<ConnectionState, string>> = {
  connecting: t("Connecting …"),
  connected: t("Connected"),
  lost: t("Connection lost, trying again …"),
  closed: t("Not connected"),
};

/** `but`: what keeps that there is a connection from being all there is to say; empty where nothing does. */
export function Connection({ but = "" }: { but?: string }) {
  const state = connection.value === "connected" && but !== "" ? "lost" : connection.value;
  return (
    <p class={`connection ${state}`} role="status">
      {state === connection.value ? CONNECTION[state] : but}
    </p>
  );
}

/** Task trees, the scenes that they are for, and how their robots are drawn. */
const TREE_VIEWS: ReadonlySet<string> = new Set(["trees", "tree", "edit", "scenes", "edit_scene", "models"]);

export function Header() {
  const view = route.value.view;
  const count = questions.value.length;
  return (
    <header class="header">
      <a class="brand" href="/" aria-label={t("Mend, to the questions")}>
        <img src="/icon.svg" alt="" width="28" height="28" />
        <span>Mend</span>
      </a>
      <nav aria-label={t("Main")}>
        <Place href="/" current={view === "questions"}>
          {t("Questions")}
          {count > 0 && <span class="count">{count}</span>}
        </Place>
        <Place href="/runs" current={view === "runs" || view === "run" || view === "start"}>
          {t("Runs")}
        </Place>
        <Place href="/issues" current={view === "issues" || view === "statistics"}>
          {t("Issues")}
        </Place>
        <Place href="/trees" current={TREE_VIEWS.has(view)}>
          {t("Task trees")}
        </Place>
        {(view === "requests" || view === "fleet" || (fleets.value?.length ?? 0) > 0) && (
          <>
            <Place href="/fleet" current={view === "fleet"}>
              {t("Fleet")}
            </Place>
            <Place href="/requests" current={view === "requests"}>
              {t("Requests")}
            </Place>
          </>
        )}
      </nav>
      <Connection />
      <a class="who" href="/settings" aria-current={view === "settings" ? "page" : undefined}>
        {helperName.value}
        {presence.value === "away" && <span class="small">{`\u00a0${t("(away)")}`}</span>}
      </a>
    </header>
  );
}

function Place(props: { href: string; current: boolean; children: preact.ComponentChildren }) {
  return (
    <a href={props.href} aria-current={props.current ? "page" : undefined}>
      {props.children}
    </a>
  );
}

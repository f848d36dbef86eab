// The frame of every view: who is signed in decides what is shown, the address which view.
import { useEffect } from "preact/hooks";
import { Announcer } from "../question/announcer";
import { AskBar } from "../question/ask_bar";
import { QuestionsView } from "../question/questions_view";
import { followFleets } from "../requests/fleets";
import { SignIn } from "../sign_in/sign_in";
import { followRobots } from "../state/robots";
import { session } from "../state/service";
import { ConnectionBar } from "./connection_bar";
import { Header } from "./header";
import { besideRobot, helperName, pushOn } from "../state/preferences";
import { MissedBar } from "../calling/missed_bar";
import { SoundBar } from "../calling/sound_bar";
import { later } from "./later";
import { type Route, route } from "./router";
import { t } from "../words/words";
import "./app.css";

const RunView = later(() => import("../run/run_view").then((module) => module.RunView));
const RunsView = later(() => import("../run/runs_view").then((module) => module.RunsView));
const IssuesView = later(() => import("../issues/issues_view").then((module) => module.IssuesView));
const StatisticsView = later(() => import("../statistics/statistics_view").then((module) => module.StatisticsView));
const TreesView = later(() => import("../trees/trees_view").then((module) => module.TreesView));
const TreeEditor = later(() => import("../trees/tree_editor").then((module) => module.TreeEditor));
const ScenesView = later(() => import("../scenes/scenes_view").then((module) => module.ScenesView));
const SceneEditor = later(() => import("../scenes/scene_editor").then((module) => module.SceneEditor));
const ModelsView = later(() => import("../models/models_view").then((module) => module.ModelsView));
const StartRun = later(() => import("../run/start/start_run").then((module) => module.StartRun));
const RequestsView = later(() => import("../requests/requests_view").then((module) => module.RequestsView));
const FleetPage = later(() => import("../fleet/fleet_page").then((module) => module.FleetPage));
const TouchView = later(() => import("../touch/touch_view").then((module) => module.TouchView));
const SettingsView = later(() => import("../settings/settings_view").then((module) => module.SettingsView));

export function App() {
  useEffect(() => (session.value === "in" ? followFleets() : undefined), [session.value]);
  useEffect(() => (session.value === "in" ? followRobots() : undefined), [session.value]);
  useEffect(() => (session.value === "in" && besideRobot.value ? standBeside() : undefined), [session.value, besideRobot.value]);
  useEffect(() => {
    if (session.value === "in" && pushOn.value) void import("../calling/push").then((push) => push.callThisDeviceStill());
  }, [session.value, helperName.value]);
  if (session.value === "unknown") return <p class="app-waiting">{t("Looking for the service …")}</p>;
  if (session.value !== "in") return <SignIn />;
  const shown = route.value;
  // Who stands before a robot is no helper of others: no questions, and no way to other pages.
  if (shown.view === "touch") {
    return (
      <main id="main" tabIndex={-1}>
        <TouchView key={shown.robot} robot={shown.robot} />
      </main>
    );
  }
  return (
    <>
      <a class="skip" href="#main">
        {t("Skip to content")}
      </a>
      <div class="top">
        <Header />
        <ConnectionBar />
        <MissedBar />
        <SoundBar />
      </div>
      <Announcer />
      <AskBar />
      <main id="main" tabIndex={-1}>
        <View shown={shown} />
      </main>
    </>
  );
}

function View({ shown }: { shown: Exclude<Route, { view: "touch" }> }) {
  switch (shown.view) {
    case "questions":
      return <QuestionsView />;
    case "runs":
      return <RunsView />;
    case "issues":
      return <IssuesView />;
    case "run":
      return <RunView key={shown.run} run={shown.run} />;
    case "statistics":
      return <StatisticsView />;
    case "trees":
      return <TreesView tree={null} />;
    case "tree":
      return <TreesView tree={shown.tree} />;
    case "edit":
      return <TreeEditor key={shown.tree} tree={shown.tree} />;
    case "scenes":
      return <ScenesView />;
    case "edit_scene":
      return <SceneEditor key={shown.scene} scene={shown.scene} />;
    case "models":
      return <ModelsView />;
    case "start":
      return <StartRun key={shown.tree} tree={shown.tree} />;
    case "requests":
      return <RequestsView />;
    case "fleet":
      return <FleetPage site={shown.site} />;
    case "settings":
      return <SettingsView />;
    case "unknown":
      return (
        <section class="page">
          <h1>{t("There is nothing at {path}", { path: shown.path })}</h1>
          <p>
            <a href="/">{t("To the questions")}</a>
          </p>
        </section>
      );
  }
}

/** Its code is loaded on devices that stand beside a robot. */
function standBeside(): () => void {
  const begun = import("../calling/beside_robot").then((beside) => beside.standBeside());
  return () => void begun.then((stop) => stop());
}

// One run: where it stands or stood at a moment, as a tree, a timeline and a transcript.
import { useComputed } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useCallback, useEffect, useMemo, useState } from "preact/hooks";
import { later } from "../app/later";
import { planOf } from "../building/plan";
import { RunQuestion } from "../question/run_question";
import { noteKnown } from "../state/failures";
import { awaitingHelp, questions, together } from "../state/questions";
import { TreeDrawing } from "../tree/tree_drawing";
import { nodesOfRun, type Steered } from "../tree/tree_node";
import { plain } from "../tree/words";
import type { Told } from "../wire/told";
import type { NodeStarted, NodeView } from "../wire/types";
import { Cameras } from "./cameras";
import { ChoicePanel } from "./choice_panel";
import { DialogueNow } from "./dialogue_now";
import { ended, nodeViews, type RunState } from "./fold";
import { Leaves } from "./leaves";
import { faultBeside } from "./faults";
import { useFaultKeys } from "./fault_keys";
import { doersOf } from "./leaf_words";
import { useMomentInAddress } from "./moment_in_address";
import { openRun, type RunFeed } from "./run_feed";
import { RunHeader } from "./run_header";
import { runLayout } from "./kept_layout";
import { styleOf } from "./run_layout";
import { Splitters } from "./splitters";
import { steeredOf } from "./steering/steered";
import { waitsOf } from "./steering/waits";
import { Scrubber } from "./scrubber";
import { Tabs, useNarrow } from "./tabs";
import { lanesOf, type TimelineItem } from "./timeline/lanes";
import { Timeline } from "./timeline/timeline";
import { Transcript } from "./transcript";
import { usePlaying } from "./use_playing";
import { t } from "../words/words";
import "./run.css";

const ScenePanel = later(() => import("./scene/scene_panel").then((module) => module.ScenePanel));

const SteeringPanel = later(() => import("./steering/steering_panel").then((module) => module.SteeringPanel));

const RunWaits = later(() => import("./steering/run_waits").then((module) => module.RunWaits));

const Plots = later(() => import("./plots/plots").then((module) => module.Plots));

const PlanPanel = later(() => import("../building/plan_panel").then((module) => module.PlanPanel));

/** The world whose robots have no cameras. */
const BLIND_WORLD = "building";

const LANE_STEP_S = 0.5;

export function RunView({ run }: { run: string }) {
  const feed = useFeed(run);
  if (feed === null) return <p class="page quiet">{t("Loading …")}</p>;
  return <Followed run={run} feed={feed} />;
}

function useFeed(run: string): RunFeed | null {
  const [feed, setFeed] = useState<RunFeed | null>(null);
  useEffect(() => {
    const opened = openRun(run);
    setFeed(opened);
    return () => opened.close();
  }, [run]);
  return feed;
}

function Followed({ run, feed }: { run: string; feed: RunFeed }) {
  const { history, moment } = feed;
  const version = feed.version.value;
  usePlaying(feed.moment);
  useMomentInAddress(moment, version > 0);
  // Time passes all along; what is drawn changes with the events alone.
  const count = useComputed(() => {
    if (moment.newest.value) return Infinity;
    // More events may have come for the very time that is shown.
    void feed.version.value;
    return history.countAt(moment.time.value, moment.seq.value);
  }).value;
  const state = useMemo(() => history.stateAfter(Math.max(count, 1)), [history, count, version]);
  const latest = history.stateAfter(history.events.length);
  const seenToFail = feed.failure.value !== null || latest?.status === "failed";
  useEffect(() => {
    if (seenToFail) noteKnown(run);
  }, [run, seenToFail]);
  if (feed.failure.value !== null) return <NotThere reason={feed.failure.value} />;
  if (state === null || latest === null) return <p class="page quiet">{t("Loading …")}</p>;
  return <Shown feed={feed} version={version} state={state} latest={latest} />;
}

function NotThere({ reason }: { reason: string }) {
  return (
    <section class="page">
      <h1>{t("This run cannot be shown")}</h1>
      <p>{reason}</p>
      <p>
        <a href="/runs">{t("To the runs")}</a>
      </p>
    </section>
  );
}

interface ShownProps {
  feed: RunFeed;
  version: number;
  /** The state at the moment, and that after the last event. */
  state: RunState;
  latest: RunState;
}

function Shown({ feed, version, state, latest }: ShownProps) {
  const { history, moment } = feed;
  const newest = moment.newest.value;
  const narrow = useNarrow();
  const [selected, setSelected] = useState<string | null>(null);
  const goToEvent = useCallback(
    (event: { seq: number; time: number }) => moment.goTo(event.time, event.seq),
    [moment],
  );
  const step = useCallback(
    (direction: -1 | 1) => {
      const at = moment.newest.value
        ? history.events.length
        : history.countAt(moment.time.value, moment.seq.value);
      const event = history.events[at - 1 + direction];
      if (event === undefined) moment.goToNewest();
      else if (at + direction >= history.events.length) moment.goToNewest();
      else goToEvent(event);
    },
    [history, moment, goToEvent],
  );
  // At the end that is the last event, which may itself be a fault.
  const shownSeq = newest ? Infinity : state.seq;
  const goToFault = useCallback(
    (direction: -1 | 1) => {
      const fault = faultBeside(history.events, shownSeq, direction);
      if (fault === null) return;
      if (fault.type !== "robot_lost") setSelected(fault.node);
      goToEvent(fault);
    },
    [history, shownSeq, goToEvent],
  );
  useFaultKeys(goToFault);
  const faultSteps = (direction: -1 | 1) =>
    faultBeside(history.events, shownSeq, direction) === null ? null : () => goToFault(direction);
  const views = useMemo(
    () => nodeViews(state),
    [state.leaves, state.abandoned, state.potentials, state.status],
  );
  const choices = useChoices(feed, state, selected);
  const talkedAbout = useTalkedAbout(state);
  const waits = useMemo(() => waitsOf(state), [state.steering, state.leaves, state.abandoned, state.status]);
  const steered = useMemo(() => steeredOf(state.steering, waits), [state.steering, waits]);
  // Made anew only with what it shows: most events change neither the tree nor the selection.
  const tree = useMemo(
    () => (
      <TreePanel
        name={state.started.tree_name}
        views={views}
        people={state.people}
        talkedAbout={talkedAbout}
        result={state.result}
        steered={steered}
        selected={selected}
        onSelect={setSelected}
      />
    ),
    [views, state.people, talkedAbout, state.result, steered, selected],
  );
  const chosen = views.find((view) => view.node === selected) ?? null;
  const choice = (
    <div class="run-choice">
      <SteeringPanel state={state} selected={chosen} newest={newest} onSelect={setSelected} />
      <ChoicePanel node={chosen} choices={choices} result={state.result} onChoose={goToEvent} />
      {(state.people.size > 0 || !ended(latest.status)) && (
        <Leaves
          run={state.started.run}
          people={state.people}
          selected={chosen}
          example={plain(views.find(({ object }) => object !== null)?.object ?? t("part"))}
          going={newest && state.status === "running"}
        />
      )}
    </div>
  );
  const talk = (
    <Talk state={state} newest={newest}>
      {waits.length > 0 && <RunWaits run={state.started.run} waits={waits} going={newest} />}
    </Talk>
  );
  const timeline = useMemo(
    () => (
      <TimelinePanel run={state.started.run} feed={feed} version={version} onSelect={setSelected} onGoTo={goToEvent} />
    ),
    [state.started.run, feed, version, goToEvent],
  );
  const { scene } = state.started;
  const plan = useMemo(() => planOf(scene), [scene]);
  const world = useMemo(
    () =>
      plan === null ? (
        <ScenePanel run={state.started.run} moment={moment} doers={doersOf(state)} />
      ) : (
        <PlanPanel plan={plan} run={state.started.run} moment={moment} state={state} />
      ),
    [plan, state.started.run, moment, plan === null ? state.people : state],
  );
  const cameras = useMemo(
    () => state.started.world !== BLIND_WORLD && <Cameras run={state.started.run} robots={state.started.robots} moment={moment} status={latest.status} />,
    [state.started, moment, latest.status],
  );
  const transcript = (
    <section class="panel run-transcript">
      <h2>{t("Transcript")}</h2>
      <Transcript events={history.events} version={version} until={newest ? null : state.seq} onChoose={goToEvent} />
    </section>
  );
  return (
    <div class={`run-view ${newest ? "" : "in-past"} ${plan === null ? "" : "in-building"}`} style={styleOf(runLayout.value)}>
      <RunHeader newest={latest} moment={moment} />
      {narrow ? (
        <>
          {talk}
          <Tabs
            panels={[
              { id: "tree", name: t("Tree"), content: [tree, choice] },
              { id: "world", name: plan === null ? t("Scene") : t("Building"), content: [world, cameras] },
              { id: "timeline", name: t("Timeline"), content: timeline },
              { id: "transcript", name: t("Transcript"), content: transcript },
            ]}
          />
        </>
      ) : (
        <>
          <div class="run-area world">{world}</div>
          <div class="run-area tree">{tree}</div>
          <Splitters />
          <div class="run-area timeline">{timeline}</div>
          <div class="run-area side">
            {talk}
            {cameras}
            {choice}
            {transcript}
          </div>
        </>
      )}
      <Scrubber
        moment={moment}
        going={!ended(latest.status)}
        onStep={step}
        faults={{ before: faultSteps(-1), after: faultSteps(1) }}
      />
    </div>
  );
}

/** The open question, or what was being talked about at a moment of the past. */
function Talk({ state, newest, children }: { state: RunState; newest: boolean; children: ComponentChildren }) {
  const { run } = state.started;
  const asked = questions.value.some((question) => question.run === run);
  const known = new Set([...questions.value, ...awaitingHelp.value, ...together.value].map((each) => each.dialogue));
  // What has a card for helpers is not told once more.
  const told = [...state.dialogues.values()].filter(({ opened }) => !newest || !known.has(opened.dialogue));
  return (
    <div class="run-talk">
      {children}
      {newest && <RunQuestion run={run} />}
      {!newest && asked && <p class="run-waiting">{t("A question is open now: go back to live to answer it.")}</p>}
      {told.map((dialogue) => (
        <DialogueNow key={dialogue.opened.dialogue} dialogue={dialogue} />
      ))}
    </div>
  );
}

/** The leaves that an open dialogue is about; the same set as long as they are. */
function useTalkedAbout(state: RunState): ReadonlySet<string> {
  const paths = [...state.dialogues.values()].map((dialogue) => dialogue.opened.node);
  return useMemo(() => new Set(paths), [paths.join(" ")]);
}

interface TreePanelProps {
  name: string;
  views: readonly NodeView[];
  people: RunState["people"];
  talkedAbout: ReadonlySet<string>;
  result: RunState["result"];
  steered: ReadonlyMap<string, Steered>;
  selected: string | null;
  onSelect: (path: string | null) => void;
}

function TreePanel({ name, views, people, talkedAbout, result, steered, selected, onSelect }: TreePanelProps) {
  const nodes = useMemo(
    () => nodesOfRun(views, talkedAbout, people, result, steered),
    [views, talkedAbout, people, result, steered],
  );
  const active = nodes.find((node) => node.kind === "behavior" && node.state === "active");
  const asksOrFailed = nodes.find((node) => node.state === "in_dialogue" || node.state === "failed");
  const focus = asksOrFailed ?? active;
  return (
    <section class="panel run-tree">
      <h2>{t("Task tree|of this run")}</h2>
      <TreeDrawing
        nodes={nodes}
        label={t("Task tree of {name}", { name: plain(name) })}
        selected={selected}
        focus={focus?.path ?? null}
        onSelect={(path) => onSelect(path === selected ? null : path)}
      />
      <p class="tree-legend small quiet">{t("↓ level · ↑ potential")}</p>
    </section>
  );
}

/** The choices of a node up to a state, or the last choice of all. */
function useChoices(feed: RunFeed, state: RunState, selected: string | null): readonly NodeStarted[] {
  return useMemo(() => {
    if (selected === null) return state.choice === null ? [] : [state.choice];
    return feed.history.events.filter(
      (event): event is Extract<Told, NodeStarted> =>
        event.type === "node_started" && event.node === selected && event.seq <= state.seq,
    );
  }, [feed, state, selected]);
}

interface TimelinePanelProps {
  run: string;
  feed: RunFeed;
  version: number;
  onSelect: (path: string) => void;
  onGoTo: (event: { seq: number; time: number }) => void;
}

function TimelinePanel({ run, feed, version, onSelect, onGoTo }: TimelinePanelProps) {
  const { history, moment } = feed;
  // Not every frame of poses: the lanes grow in steps that nobody sees.
  const end = useComputed(() => Math.ceil(moment.end.value / LANE_STEP_S) * LANE_STEP_S).value;
  const lanes = useMemo(() => lanesOf(history.events, end), [history, version, end]);
  const [plotted, setPlotted] = useState(false);
  const choose = (item: TimelineItem) => {
    if (item.node !== null) onSelect(item.node);
    onGoTo({ seq: item.seq, time: item.start });
  };
  return (
    <div class="panel run-timeline">
      <Timeline
        lanes={lanes}
        end={end}
        moment={moment}
        onChoose={choose}
        more={
          <button type="button" class="small-button" aria-expanded={plotted} onClick={() => setPlotted(!plotted)}>{t("Plots")}</button>
        }
      />
      {plotted && <Plots run={run} history={history} version={version} end={end} moment={moment} />}
    </div>
  );
}

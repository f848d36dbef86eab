// One run: where it stands or stood at a moment, as a tree, a timeline and a transcript.
import { useCallback, useEffect, useMemo, useState } from "preact/hooks";
import { QuestionCard } from "../question/question_card";
import { questions } from "../state/questions";
import { TreeDrawing } from "../tree/tree_drawing";
import { nodesOfRun } from "../tree/tree_node";
import { plain } from "../tree/words";
import type { NodeStarted, NodeView } from "../wire/types";
import { Cameras } from "./cameras";
import { ChoicePanel } from "./choice_panel";
import { DialogueNow } from "./dialogue_now";
import { ended, nodeViews, type RunState } from "./fold";
import { openRun, type RunFeed } from "./run_feed";
import { RunHeader } from "./run_header";
import { ScenePanel } from "./scene/scene_panel";
import { Scrubber } from "./scrubber";
import { Tabs, useNarrow } from "./tabs";
import { Timeline } from "./timeline";
import { lanesOf, type TimelineItem } from "./timeline_lanes";
import { Transcript } from "./transcript";
import "./run.css";

export function RunView({ run }: { run: string }) {
  const feed = useFeed(run);
  if (feed === null) return <p class="page quiet">Loading …</p>;
  return <Followed feed={feed} />;
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

function Followed({ feed }: { feed: RunFeed }) {
  const { history, moment } = feed;
  const version = feed.version.value;
  usePlaying(feed);
  const time = moment.time.value;
  const newest = moment.newest.value;
  const count = newest ? history.events.length : history.countAt(time, moment.seq.value);
  const state = useMemo(() => history.stateAfter(Math.max(count, 1)), [history, count, version]);
  const latest = history.stateAfter(history.events.length);
  if (feed.failure.value !== null) return <NotThere reason={feed.failure.value} />;
  if (state === null || latest === null) return <p class="page quiet">Loading …</p>;
  return <Shown feed={feed} version={version} state={state} latest={latest} />;
}

function NotThere({ reason }: { reason: string }) {
  return (
    <section class="page">
      <h1>This run cannot be shown</h1>
      <p>{reason}</p>
      <p>
        <a href="/runs">To the runs</a>
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
  const views = useMemo(() => nodeViews(state), [state]);
  const choices = useChoices(feed, state, selected);
  const tree = <TreePanel state={state} views={views} selected={selected} onSelect={setSelected} />;
  const choice = (
    <ChoicePanel node={views.find((view) => view.node === selected) ?? null} choices={choices} onChoose={goToEvent} />
  );
  const timeline = <TimelinePanel feed={feed} version={version} onSelect={setSelected} onGoTo={goToEvent} />;
  const transcript = (
    <section class="panel run-transcript">
      <h2>Transcript</h2>
      <Transcript events={history.events} version={version} until={newest ? null : state.seq} onChoose={goToEvent} />
    </section>
  );
  const { run } = state.started;
  const scene = <ScenePanel key={run} run={run} moment={moment} />;
  const cameras = <Cameras run={run} moment={moment} status={latest.status} />;
  return (
    <div class={`run-view ${newest ? "" : "in-past"}`}>
      <RunHeader newest={latest} time={moment.end.value} />
      {narrow ? (
        <>
          <Talk state={state} newest={newest} />
          <Tabs
            panels={[
              { id: "tree", name: "Tree", content: [tree, choice] },
              { id: "scene", name: "Scene", content: [scene, cameras] },
              { id: "timeline", name: "Timeline", content: timeline },
              { id: "transcript", name: "Transcript", content: transcript },
            ]}
          />
        </>
      ) : (
        <>
          <div class="run-area tree">{tree}</div>
          <div class="run-area scene-area">{scene}</div>
          <div class="run-area cameras-area">{cameras}</div>
          <div class="run-area timeline">{timeline}</div>
          <div class="run-area side">
            <Talk state={state} newest={newest} />
            {choice}
            {transcript}
          </div>
        </>
      )}
      <Scrubber moment={moment} going={!ended(latest.status)} onStep={step} />
    </div>
  );
}

/** The open question, or what was being talked about at a moment of the past. */
function Talk({ state, newest }: { state: RunState; newest: boolean }) {
  const asked = questions.value.filter((question) => question.run === state.started.run);
  const dialogues = [...state.dialogues.values()];
  if (newest && asked[0] !== undefined) {
    return (
      <div class="run-talk">
        <QuestionCard key={asked[0].dialogue} question={asked[0]} />
      </div>
    );
  }
  if (dialogues.length === 0) return null;
  return (
    <div class="run-talk">
      {!newest && asked.length > 0 && <p class="run-waiting">A question is open now: go back to live to answer it.</p>}
      {dialogues.map((dialogue) => (
        <DialogueNow key={dialogue.opened.dialogue} dialogue={dialogue} />
      ))}
    </div>
  );
}

interface TreePanelProps {
  state: RunState;
  views: readonly NodeView[];
  selected: string | null;
  onSelect: (path: string | null) => void;
}

function TreePanel({ state, views, selected, onSelect }: TreePanelProps) {
  const talkedAbout = useMemo(
    () => new Set([...state.dialogues.values()].map((dialogue) => dialogue.opened.node)),
    [state.dialogues],
  );
  const nodes = useMemo(() => nodesOfRun(views, talkedAbout), [views, talkedAbout]);
  const active = nodes.find((node) => node.kind === "behavior" && node.state === "active");
  const focus = nodes.find((node) => node.state === "in_dialogue") ?? active;
  return (
    <section class="panel run-tree">
      <h2>Task tree</h2>
      <TreeDrawing
        nodes={nodes}
        label={`Task tree of ${plain(state.started.tree_name)}`}
        selected={selected}
        focus={focus?.path ?? null}
        onSelect={(path) => onSelect(path === selected ? null : path)}
      />
      <p class="tree-legend small quiet">↓ level, handed down · ↑ potential, handed up</p>
    </section>
  );
}

/** The choices of a node up to a state, or the last choice of all. */
function useChoices(feed: RunFeed, state: RunState, selected: string | null): readonly NodeStarted[] {
  return useMemo(() => {
    if (selected === null) return state.choice === null ? [] : [state.choice];
    return feed.history.events.filter(
      (event): event is NodeStarted =>
        event.type === "node_started" && event.node === selected && event.seq <= state.seq,
    );
  }, [feed, state, selected]);
}

interface TimelinePanelProps {
  feed: RunFeed;
  version: number;
  onSelect: (path: string) => void;
  onGoTo: (event: { seq: number; time: number }) => void;
}

function TimelinePanel({ feed, version, onSelect, onGoTo }: TimelinePanelProps) {
  const { history, moment } = feed;
  const end = moment.end.value;
  const lanes = useMemo(() => lanesOf(history.events, end), [history, version, end]);
  const choose = (item: TimelineItem) => {
    if (item.node !== null) onSelect(item.node);
    onGoTo({ seq: item.seq, time: item.start });
  };
  return (
    <div class="panel run-timeline">
      <Timeline lanes={lanes} end={end} time={moment.time.value} onGoTo={(time) => moment.goTo(time)} onChoose={choose} />
    </div>
  );
}

/** While the past is played, time passes with the frames that are drawn. */
function usePlaying({ moment }: RunFeed): void {
  const playing = moment.playing.value;
  useEffect(() => {
    if (!playing) return;
    let before = performance.now();
    let frame = 0;
    const pass = (now: number) => {
      moment.advance((now - before) / 1000);
      before = now;
      frame = requestAnimationFrame(pass);
    };
    frame = requestAnimationFrame(pass);
    return () => cancelAnimationFrame(frame);
  }, [moment, playing]);
}

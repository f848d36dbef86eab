"""The report is one file that tells a run truly and needs nothing else."""

import base64
import itertools
import re
from collections.abc import Sequence
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, get_args
from uuid import UUID

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.server.journal import events as ev
from mend.server.report.page import render_report, write_report
from mend.server.report.record import RunRecord
from mend.server.report.timeline import CHARACTER_PX, lay_out_timeline
from mend.server.report.tree_drawing import (
    MAX_TOUCHED,
    NODE_HEIGHT_PX,
    NodeState,
    draw_tree,
    parent_path,
)
from mend.server.report.tree_state import node_states

RECORDED = Path(__file__).parent / "recorded" / "eket_paper.jsonl"
JPEG = b"\xff\xd8 a picture \xff\xd9"
VOID = {"meta", "img", "br", "hr", "input", "link"}


def recorded() -> list[ev.Event]:
    return [ev.any_event.validate_json(line) for line in RECORDED.read_text().splitlines()]


def issues(events: Sequence[ev.Event]) -> list[ev.IssueRaised]:
    return [each for each in events if isinstance(each, ev.IssueRaised)]


def until(kind: type[ev.Event], count: int = 1) -> list[ev.Event]:
    """The recorded events up to and with the count-th of a kind."""
    events: list[ev.Event] = []
    for event in recorded():
        events.append(event)
        count -= isinstance(event, kind)
        if count == 0:
            return events
    raise AssertionError(f"the recording has too few {kind.__name__}")


class Page(HTMLParser):
    """Reads a page: its text, its pictures, what it would load; checks that its tags close."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loads: list[str] = []
        self.tags: list[str] = []
        self.text = ""
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.loads += [value or "" for name, value in attrs if name in ("src", "href", "data")]
        if tag not in VOID and self.get_starttag_text()[-2:] != "/>":  # type: ignore[index]
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID and self.open and self.get_starttag_text():
            assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.loads += [value or "" for name, value in attrs if name in ("src", "href", "data")]

    def handle_data(self, data: str) -> None:
        self.text += data


def test_report_loads_nothing_but_the_pictures_that_it_holds() -> None:
    events = recorded()
    pictures = {each.picture: JPEG for each in issues(events) if each.picture}
    html = render_report(events, pictures)
    page = Page(html)
    encoded = base64.b64encode(JPEG).decode()
    assert page.loads == [f"data:image/jpeg;base64,{encoded}"] * len(issues(events))
    assert not {"script", "link", "iframe", "object"} & set(page.tags)
    assert not re.search(r"url\(|@import|https?://", html)


def test_report_tells_every_issue_answer_and_resolution() -> None:
    text = Page(render_report(recorded(), {})).text
    for event in recorded():
        if isinstance(event, ev.IssueRaised):
            assert event.issue in text
        elif isinstance(event, ev.Prompt):
            assert event.text in text
        elif isinstance(event, ev.Resolved):
            assert f"resolved by {event.resolution}" in text
    assert text.count("No picture was taken.") == len(issues(recorded()))


def test_what_comes_from_a_run_is_shown_and_never_interpreted() -> None:
    nasty = "<script>alert('&')</script>"
    events = [
        each.model_copy(update={"text": nasty}) if isinstance(each, ev.Prompt) else each
        for each in recorded()
    ]
    page = Page(render_report(events, {}))
    assert "script" not in page.tags
    assert nasty in page.text


@pytest.mark.parametrize(
    ("end", "verdict", "status"),
    [
        (ev.RunFailed, "The run failed: nobody helped.", "failed"),
        (ev.RunAborted, "The run was aborted: Ctrl-C.", "aborted"),
        (None, "The run has not ended.", "unfinished"),
    ],
)
def test_a_run_that_did_not_finish_says_so_at_once(end: Any, verdict: str, status: str) -> None:
    events = recorded()[:-1]
    if end is not None:
        reason = "nobody helped" if end is ev.RunFailed else "Ctrl-C"
        last = events[-1]
        events.append(
            end(
                seq=last.seq + 1,
                time=last.time,
                wall_time=last.wall_time,
                run=last.run,
                reason=reason,
            )
        )
    page = Page(render_report(events, {}))
    assert verdict in page.text
    assert RunRecord(events).status == status


def test_a_report_of_a_run_cut_off_anywhere_can_be_written() -> None:
    events = recorded()
    for count in range(1, len(events) + 1, 7):
        Page(render_report(events[:count], {}))


def test_missing_parts_are_named_in_the_verdict() -> None:
    events = recorded()
    part = ev.MissingPart(
        node="/0", name="green_leg", object="green_leg", place="its_place", left_out_by="ann"
    )
    events[-1] = events[-1].model_copy(update={"missing": [part]})
    assert "green_leg is not at its_place, as ann said" in Page(render_report(events, {})).text


def test_report_is_written_into_a_folder_that_is_made_for_it(tmp_path: Path) -> None:
    path = tmp_path / "out" / "run.html"
    write_report(path, recorded(), {})
    assert path.read_text(encoding="utf-8").startswith("<!doctype html>")


def test_only_the_whole_events_of_one_run_make_a_report() -> None:
    events = recorded()
    with pytest.raises(ValueError, match="from its run_started on"):
        RunRecord(events[1:])
    with pytest.raises(ValueError, match="from its run_started on"):
        RunRecord([])
    stranger = events[-1].model_copy(update={"run": UUID(int=9)})
    with pytest.raises(ValueError, match="alone"):
        RunRecord([*events, stranger])


# --- What is gathered -------------------------------------------------------------------------


def test_a_fault_knows_what_led_to_it_and_how_it_was_resolved() -> None:
    first = RunRecord(recorded()).faults[0]
    assert isinstance(first.story[0], ev.InterventionDone)
    assert first.story[0].act == "steal"
    assert first.outcome == "human_finish"
    assert first.end_s is not None
    assert first.end_s > first.raised.time


def test_a_fault_whose_dialogue_did_not_close_is_open() -> None:
    assert RunRecord(until(ev.Prompt)).faults[0].outcome == "open"


def test_steps_end_where_the_next_begins_or_the_fault_interrupts() -> None:
    record = RunRecord(recorded())
    for execution in record.executions:
        for step, following in zip(execution.steps, execution.steps[1:], strict=False):
            assert step.end_s is not None
            assert step.start_s <= step.end_s <= following.start_s
    interrupted = record.executions[1]
    assert interrupted.steps[-1].end_s == record.faults[0].raised.time


def test_an_execution_is_done_put_back_or_cut_off() -> None:
    record = RunRecord(until(ev.NodeStarted, 4))
    assert [each.ending for each in record.executions] == ["done", "done", "put back", "cut off"]


def test_tree_state_is_what_the_events_say() -> None:
    fates = {each.name: each.fate for each in node_states(RunRecord(recorded()))}
    assert fates["green_leg"] == "done"
    assert fates["orange_top"] == "untouched"
    early = {each.path: each.fate for each in node_states(RunRecord(until(ev.NodeStarted, 2)))}
    assert early["/0"] == "done"
    assert early["/1/0"] == "active"


@pytest.mark.parametrize("by", get_args(ev.DoneBy))
def test_whoever_brought_a_result_about_is_told(by: ev.DoneBy) -> None:
    events = [
        each.model_copy(update={"by": by}) if isinstance(each, ev.NodeDone) else each
        for each in recorded()
    ]
    words = {"both": "by robot and human", "found": "found in place"}.get(by, f"by the {by}")
    details = [each.detail for each in node_states(RunRecord(events)) if each.fate == "done"]
    assert any(words in each for each in details)


# --- The timeline -----------------------------------------------------------------------------


def timeline_events(times: Sequence[float]) -> list[ev.Event]:
    """A run with an issue at each of the times."""
    started = recorded()[0]
    template = issues(recorded())[0]
    events: list[ev.Event] = [started]
    begun = next(each for each in recorded() if isinstance(each, ev.NodeStarted))
    events.append(
        begun.model_copy(update={"node": template.node, "name": template.name, "time": 0})
    )
    events += [template.model_copy(update={"time": each}) for each in sorted(times)]
    return events


@settings(deadline=None, max_examples=sample(20, 60))
@given(st.lists(st.floats(0.0, 5000.0), min_size=1, max_size=12))
def test_nothing_on_the_timeline_leaves_it_or_hides_other_words(times: list[float]) -> None:
    timeline = lay_out_timeline(RunRecord(timeline_events(times)))
    (row,) = timeline.rows
    assert row.bottom <= timeline.height
    for bar in row.bars:
        assert timeline.plot_left <= bar.x <= timeline.plot_right
        assert bar.x + bar.width <= timeline.plot_right + 1
    spans = sorted(
        (each.level, each.x - width if each.end else each.x, width)
        for each in row.captions
        for width in [len(each.text) * CHARACTER_PX]
    )
    for (level, left, width), (next_level, next_left, _) in itertools.pairwise(spans):
        assert level != next_level or left + width <= next_left


@pytest.mark.parametrize("end_s", [0.0, 0.4, 73.0, 600.0, 90000.0])
def test_the_axis_always_has_ticks_that_can_be_read(end_s: float) -> None:
    timeline = lay_out_timeline(RunRecord(timeline_events([end_s])))
    xs = [each.x for each in timeline.ticks]
    assert 1 <= len(xs) <= 60
    assert all(after - before >= 50 for before, after in itertools.pairwise(xs))


# --- The drawing of the tree ------------------------------------------------------------------


def tree_of(parents: Sequence[int], touched: bool = True) -> list[NodeState]:
    """Nodes from the index of each one's parent (always an earlier one), parents first."""
    paths = ["/"]
    below = [0]
    for parent in parents:
        prefix = "" if parent == 0 else paths[parent]
        paths.append(f"{prefix}/{below[parent]}")
        below[parent] += 1
        below.append(0)
    goals = set(parents) | {0}
    return [
        NodeState(
            path,
            "and" if index in goals else "behavior",
            f"n{index}",
            None,
            "done" if touched else "untouched",
        )
        for index, path in enumerate(paths)
    ]


@settings(deadline=None, max_examples=60)
@given(st.data())
def test_nodes_of_the_drawing_never_overlap_and_goals_stand_among_their_children(
    data: st.DataObject,
) -> None:
    count = data.draw(st.integers(1, 40))
    parents = [data.draw(st.integers(0, index)) for index in range(count)]
    states = tree_of(parents)
    drawing = draw_tree(states)
    nodes = {each.state.path: each for each in drawing.nodes}
    assert set(nodes) == {each.path for each in states}
    assert len(drawing.edges) == len(states) - 1
    for one in drawing.nodes:
        assert one.x + one.width <= drawing.width
        assert one.y + NODE_HEIGHT_PX / 2 <= drawing.height
        for other in drawing.nodes:
            apart = (
                one is other
                or abs(one.y - other.y) >= NODE_HEIGHT_PX
                or one.x + one.width <= other.x
                or other.x + other.width <= one.x
            )
            assert apart
    for path, node in nodes.items():
        below = [nodes[each.path].y for each in states[1:] if parent_path(each.path) == path]
        if below:
            assert min(below) <= node.y <= max(below)


def test_children_of_a_then_are_numbered_and_others_are_not() -> None:
    drawing = draw_tree(node_states(RunRecord(recorded())))
    assert [each.order for each in drawing.edges if each.kind == "then"] == [1, 2, 3, 4]
    assert {each.order for each in drawing.edges if each.kind != "then"} == {None}


def test_a_very_large_tree_is_drawn_as_far_as_it_was_touched() -> None:
    states = tree_of([0] * 30 + [1 + i % 30 for i in range(MAX_TOUCHED * 2)], touched=False)
    states[40] = NodeState(states[40].path, "behavior", "it", None, "done")
    drawing = draw_tree(states)
    kinds = [each.state.kind for each in drawing.nodes]
    assert len(kinds) < 10
    assert "it" in [each.state.name for each in drawing.nodes]
    hidden = sum(
        int(each.state.name.split()[0]) for each in drawing.nodes if each.state.kind == "stub"
    )
    assert hidden > 0


def test_a_very_deep_tree_is_drawn() -> None:
    drawing = draw_tree(tree_of(list(range(MAX_TOUCHED - 2))))
    assert len(drawing.nodes) == MAX_TOUCHED - 1


def test_linear_colours_become_what_a_screen_shows() -> None:
    started = recorded()[0]
    assert isinstance(started, ev.RunStarted)
    part = {"size": [0.1, 0.1, 0.1], "pose": {"x": 0.5, "y": 0.0}}
    scene = {
        "name": "s",
        "places": {},
        "objects": {"green_leg": {**part, "color": [1.0, 0.5, 0.0]}},
    }
    html = render_report([started.model_copy(update={"scene": scene}), *recorded()[1:]], {})
    assert "#ffbc00" in html


def test_begin_is_told_in_utc() -> None:
    started = recorded()[0].model_copy(
        update={"wall_time": datetime(2026, 3, 4, 9, 30, tzinfo=UTC)}
    )
    assert "2026-03-04 09:30:00 UTC" in render_report([started, *recorded()[1:]], {})

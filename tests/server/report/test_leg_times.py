"""Each second of a leg goes by with one thing, as its runs say; nothing is guessed."""

import itertools
import math
from collections.abc import Callable

import pytest
from fleet_events import LegMaker, RunMaker
from hypothesis import given
from hypothesis import strategies as st

from mend.fleet.requests import LegAction
from mend.robots.execution.phase import Phase
from mend.server.fleets.leg_task import LegStage
from mend.server.journal import events as ev
from mend.server.report.fleet_history import LegRecord
from mend.server.report.leg_times import TimeUse, metres_of, stretches_of, time_split

COLLECT = LegMaker("r0", 1, "mail", LegAction.COLLECT)
VISIT = LegMaker("r0", 1, "tea", LegAction.VISIT)


def spent(leg: LegRecord) -> dict[TimeUse, float]:
    """What there is time for."""
    return {use: seconds for use, seconds in time_split(leg).items() if seconds}


def test_a_leg_over_floors_is_told_apart_as_in_the_published_figure() -> None:
    run = COLLECT.run()
    events: list[ev.Event] = [
        run.started(),
        run.set_out(0.5),
        run.step(1.0, Phase.TRAVEL),
        run.raised(5.0, "door_closed"),
        run.resumed(11.0),
        run.step(20.0, Phase.RIDE),
        run.raised(22.0, "elevator_help"),
        run.step(50.0, Phase.TRAVEL),
        run.step(60.0, Phase.LOAD),
        run.raised(62.0, "item_not_given"),
        run.resumed(70.0),
        run.done(71.0),
    ]
    leg = LegRecord(COLLECT.begun(100.0), COLLECT.ended(172.0, barred_s=3.0), {LegStage.DO: events})
    assert spent(leg) == {
        TimeUse.START: 11.0,
        TimeUse.ELEVATOR: 30.0,
        TimeUse.NAVIGATION: 20.0,
        TimeUse.BLOCKED: 9.0,
        TimeUse.WAITING: 0.5,
        TimeUse.OTHER: 1.5,
    }


@pytest.mark.parametrize(
    ("action", "use"),
    [
        (LegAction.HAND_OVER, TimeUse.END),
        (LegAction.BRING_BACK, TimeUse.END),
        (LegAction.GIVE, TimeUse.TRANSFER),
        (LegAction.TAKE, TimeUse.TRANSFER),
    ],
)
def test_waiting_for_people_counts_as_what_they_are_to_do(action: LegAction, use: TimeUse) -> None:
    made = LegMaker("r0", 1, "mail", action)
    run = made.run()
    events = [run.started(), run.step(0.0, Phase.UNLOAD), run.done(10.0)]
    assert spent(LegRecord(made.begun(0.0), made.ended(10.0), {LegStage.DO: events})) == {use: 10.0}


def test_who_came_stays_until_its_leg_ends() -> None:
    run = VISIT.run(LegStage.GO)
    events = [run.started(), run.step(0.0, Phase.TRAVEL), run.done(10.0), run.finished(10.0)]
    leg = LegRecord(VISIT.begun(5.0), VISIT.ended(45.0), {LegStage.GO: events})
    assert spent(leg) == {TimeUse.NAVIGATION: 10.0, TimeUse.WAITING: 30.0}


def test_who_came_early_waits_between_its_two_runs() -> None:
    go, do = COLLECT.run(LegStage.GO), COLLECT.run()
    runs = {
        LegStage.GO: [
            go.started(),
            go.step(0.0, Phase.TRAVEL),
            go.done(10.0),
            go.finished(10.0),
        ],
        LegStage.DO: [do.started(), do.step(0.0, Phase.LOAD), do.done(4.0)],
    }
    leg = LegRecord(COLLECT.begun(0.0), COLLECT.ended(60.0), runs)
    assert [(each.begin_s, each.end_s, each.use) for each in stretches_of(leg)] == [
        (0.0, 10.0, TimeUse.NAVIGATION),
        (10.0, 56.0, TimeUse.WAITING),
        (56.0, 60.0, TimeUse.START),
    ]


def test_who_may_not_set_out_as_another_has_the_place_waits() -> None:
    run = COLLECT.run()
    events = [run.started(), run.set_out(28.0), run.step(28.0, Phase.TRAVEL), run.done(40.0)]
    leg = LegRecord(COLLECT.begun(0.0), COLLECT.ended(40.0), {LegStage.DO: events})
    assert spent(leg) == {TimeUse.WAITING: 28.0, TimeUse.NAVIGATION: 12.0}


def test_what_an_older_journal_does_not_say_is_not_guessed() -> None:
    run = COLLECT.run()
    events = [
        run.started(),
        run.step(0.0, None),
        run.raised(30.0, "blocked"),
        run.resumed(40.0),
        run.raised(50.0, "item_not_given"),
        run.resumed(55.0),
        run.done(60.0),
    ]
    leg = LegRecord(COLLECT.begun(0.0), COLLECT.ended(60.0), {LegStage.DO: events})
    assert spent(leg) == {TimeUse.UNKNOWN: 45.0, TimeUse.BLOCKED: 10.0, TimeUse.START: 5.0}
    assert spent(LegRecord(COLLECT.begun(0.0), COLLECT.ended(7.0))) == {TimeUse.UNKNOWN: 7.0}
    assert metres_of([leg]) is None


def test_a_robot_whose_connection_is_gone_does_nothing_that_is_known() -> None:
    run = COLLECT.run()
    events = [run.started(), run.step(0.0, Phase.TRAVEL), run.lost(4.0), run.back(9.0)]
    leg = LegRecord(COLLECT.begun(0.0), COLLECT.ended(9.0), {LegStage.DO: events})
    assert spent(leg) == {TimeUse.NAVIGATION: 4.0, TimeUse.OTHER: 5.0}


MAKES: list[Callable[[RunMaker, float], ev.Event]] = [
    RunMaker.set_out,
    RunMaker.resumed,
    RunMaker.done,
    RunMaker.lost,
    RunMaker.back,
    *(lambda run, time, phase=phase: run.step(time, phase) for phase in (None, *Phase)),
    *(
        lambda run, time, issue=issue: run.raised(time, issue)
        for issue in ("blocked", "lost", "elevator_help", "item_not_taken", "unheard_of")
    ),
]
happenings = st.lists(st.tuples(st.floats(-5.0, 200.0), st.sampled_from(MAKES)), max_size=12)


@given(
    st.sampled_from(list(LegAction)),
    st.floats(0.0, 1e5),
    st.floats(0.0, 300.0),
    st.dictionaries(st.sampled_from(list(LegStage)), happenings),
    st.none() | st.floats(0.0, 400.0),
)
def test_every_second_of_a_leg_is_in_one_class(
    action: LegAction,
    begins_s: float,
    lasts_s: float,
    runs: dict[LegStage, list[tuple[float, Callable[[RunMaker, float], ev.Event]]]],
    barred_s: float | None,
) -> None:
    made = LegMaker("r0", 1, "mail", action)
    events = {
        stage: [made.run(stage).started(), *(make(made.run(stage), time) for time, make in happens)]
        for stage, happens in runs.items()
    }
    ended = made.ended(begins_s + lasts_s, barred_s=barred_s)
    leg = LegRecord(made.begun(begins_s), ended, events)
    split, parts = time_split(leg), stretches_of(leg)
    assert min(split.values()) >= 0.0
    assert math.isclose(sum(split.values()), ended.at_s - begins_s, rel_tol=1e-9, abs_tol=1e-6)
    assert all(a.end_s == b.begin_s for a, b in itertools.pairwise(parts))
    if parts:
        assert (parts[0].begin_s, parts[-1].end_s) == (begins_s, ended.at_s)


def test_a_leg_that_was_broken_off_went_by_with_what_its_robot_was_about_until_then() -> None:
    run = COLLECT.run()
    events: list[ev.Event] = [
        run.started(),
        run.set_out(0.0),
        run.step(0.5, Phase.TRAVEL),
        run.aborted(20.0),
    ]
    ended = COLLECT.ended(120.5, "withdrawn")
    assert spent(LegRecord(COLLECT.begun(100.0), ended, {LegStage.DO: events})) == {
        TimeUse.OTHER: 0.5,
        TimeUse.NAVIGATION: 19.5,
        TimeUse.UNKNOWN: 0.5,
    }

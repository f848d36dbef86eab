"""The made-up events of a long run of a large tree, for what a page does with thousands."""

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any
from uuid import UUID, uuid4

from mend.server.journal import events as ev

STEPS = ("above pick", "pick", "close gripper", "above pick", "above place", "place")
STEPS += ("open gripper", "above place")
WALL_TIME = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
ROBOT = "pr2"
CANDIDATES = 20
FAULT_EVERY = 10


def long_run(groups: int, leaves: int) -> list[ev.Event]:
    """An AND of `groups` THENs of `leaves` leaves each, done one after the other.

    About ten events per leaf, and two dialogues in every twenty.
    """
    run = uuid4()
    return [
        _started(run, groups, leaves),
        *(
            event
            for number in range(groups * leaves)
            for event in _leaf(run, number, groups, leaves)
        ),
    ]


def _started(run: UUID, groups: int, leaves: int) -> ev.RunStarted:
    nodes: list[dict[str, Any]] = [{"kind": "and", "parent": None, "name": "all"}]
    for group in range(groups):
        parent = len(nodes)
        nodes.append({"kind": "then", "parent": 0, "name": f"group_{group}"})
        nodes += [
            {
                "kind": "behavior",
                "parent": parent,
                "name": f"part_{group * leaves + leaf}",
                "behavior": "pick_and_place",
                "parameters": {"object": f"part_{group * leaves + leaf}", "place": "shelf"},
            }
            for leaf in range(leaves)
        ]
    return ev.RunStarted(
        time=0.0,
        wall_time=WALL_TIME,
        run=run,
        tree_name="large",
        tree={"name": "large", "description": "", "scene": None, "nodes": nodes},
        scene={"name": "large", "objects": {}, "places": {}},
        world="tabletop",
        robots=[ROBOT],
        seed=0,
        speed=1.0,
        scenario=None,
        options={"tree": "large", "world": "tabletop"},
    )


def _leaf(run: UUID, number: int, groups: int, leaves: int) -> Iterator[ev.Event]:
    group, leaf = divmod(number, leaves)
    begin = number * 10.0
    node = {"node": f"/{group}/{leaf}", "name": f"part_{number}"}
    execution = uuid4()

    def at(seconds: float) -> dict[str, Any]:
        return {"time": begin + seconds, "wall_time": WALL_TIME, "run": run, **node}

    others = [each for each in range(groups) if each >= group][:CANDIDATES]
    candidates = [
        ev.Candidate(
            node=f"/{each}/{leaf if each == group else 0}",
            name=f"part_{number if each == group else each * leaves}",
            level=1 / (groups - group),
            potential=2.0 - each / groups,
            attempts=0,
        )
        for each in others
    ]
    doing = {"robot": ROBOT, "execution": execution}
    yield ev.NodeStarted(**at(0), **doing, boot="b", attempt=1, candidates=candidates)
    for step, name in enumerate(STEPS, start=1):
        yield ev.StepStarted(**at(step), **doing, step=step, step_name=name)
    if number % FAULT_EVERY == 0:
        yield from _fault(at(8.5), execution)
    yield ev.NodeDone(**at(9), robot=ROBOT, by="robot")


def _fault(base: dict[str, Any], execution: UUID) -> Iterator[ev.Event]:
    issue = {"robot": ROBOT, "issue": "dropped", "object": base["name"]}
    yield ev.IssueRaised(
        **base, **issue, place="shelf", execution=execution, step=8, interrupts=True
    )
    dialogue = {**base, **issue, "dialogue": uuid4()}
    yield ev.DialogueOpened(**dialogue)
    prompt = uuid4()
    yield ev.Prompt(**dialogue, prompt=prompt, version=1, kind="ask", text="Shall I try again?")
    yield ev.Answered(**dialogue, prompt=prompt, version=1, answer="yes", helper="anna")
    yield ev.DialogueClosed(**dialogue, reason="resolved")

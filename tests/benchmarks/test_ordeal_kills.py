"""The kills of an ordeal come when they were drawn to, each once over all lives of its world."""

import json
import os
import signal
from pathlib import Path
from random import Random
from typing import Any

import pytest
from ordeal_kills import (
    PATIENCE_S,
    SERVICE,
    WORLD,
    Executioner,
    Kill,
    Moment,
    draw_kills,
    write_kills,
)

AT_ONCE = Kill(at_s=10.0, whom=SERVICE, waits_for=None, pause_s=0.0)
LATER = Kill(at_s=12.0, whom=WORLD, waits_for=Moment.CHARGES, pause_s=0.0)


class World:
    """A world whose truth is written down, and that lives on when it is killed."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.truth, self.killed = folder / "truth.jsonl", list[int]()
        monkeypatch.setattr(os, "kill", self._kill)

    def _kill(self, process: int, number: int) -> None:
        assert number == signal.SIGKILL
        self.killed.append(process)

    def _write(self, what: str, **more: Any) -> None:
        with self.truth.open("a") as file:
            file.write(json.dumps({"t": 0.0, "what": what, **more}) + "\n")

    def begins(self, *, apart: bool = True) -> Executioner:
        return Executioner(self.truth, self._write, apart=apart)


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> World:
    made = World(tmp_path, monkeypatch)
    write_kills([AT_ONCE, LATER], made.truth)
    return made


def test_each_comes_in_its_turn_and_once(world: World) -> None:
    first = world.begins()
    first.look(9.95, {Moment.CHANGES_HANDS})
    assert world.killed == []
    first.look(10.0, set())
    assert world.killed == [os.getppid(), os.getpid()]
    world.killed.clear()

    second = world.begins()
    second.look(11.0, {Moment.CHARGES})
    second.look(12.0, {Moment.CHANGES_HANDS})
    assert world.killed == []
    second.look(12.5, {Moment.CHANGES_HANDS, Moment.CHARGES})
    assert world.killed == [os.getpid()]
    world.killed.clear()

    world.begins().look(100.0, {*Moment})
    assert world.killed == []


def test_one_that_waits_in_vain_comes_all_the_same(world: World) -> None:
    write_kills([LATER], world.truth)
    world.begins().look(LATER.at_s + PATIENCE_S[Moment.CHARGES], set())
    assert world.killed == [os.getpid()]


def test_a_world_in_the_process_of_its_service_kills_that_alone(world: World) -> None:
    world.begins(apart=False).look(10.0, set())
    assert world.killed == [os.getpid()]


def test_a_seed_has_the_same_kills_and_worlds_within_die_with_their_service() -> None:
    assert draw_kills(Random(5), 4, 60.0, apart=True) == draw_kills(Random(5), 4, 60.0, apart=True)
    within = draw_kills(Random(5), 50, 60.0, apart=False)
    assert {each.whom for each in within} == {SERVICE}
    assert [each.at_s for each in within] == sorted(each.at_s for each in within)
    assert {each.whom for each in draw_kills(Random(5), 50, 60.0, apart=True)} == {SERVICE, WORLD}

"""What the suite draws of a test's parameters is the same in each of its processes."""

import random
from dataclasses import dataclass, field

import pytest
from drawn_parameters import left_out
from sampled import EVERYTHING

FEW = 2


@dataclass(eq=False)
class Item:
    nodeid: str
    marked: bool = True
    marker: pytest.Mark = field(default_factory=lambda: pytest.mark.drawn(FEW).mark)

    def get_closest_marker(self, _: str) -> pytest.Mark | None:
        return self.marker if self.marked else None


def items() -> list[Item]:
    alike = [Item(f"test_tasks.py::test_done[{each}]") for each in "abcdef"]
    return [*alike, Item("test_tasks.py::test_one[a]"), Item("test_tasks.py::test_all[b]", False)]


def names_left_out(given: list[Item], seed: int) -> set[str]:
    return {each.nodeid for each in left_out(given, seed)}  # type: ignore[arg-type]


@pytest.fixture(autouse=True)
def _in_the_suite(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(EVERYTHING, raising=False)


@pytest.mark.parametrize("seed", range(5))
def test_as_many_are_left_as_are_to_be_whatever_their_order(seed: int) -> None:
    given = items()
    out = names_left_out(given, seed)
    assert len(out) == 6 - FEW
    assert all("test_done" in each for each in out)
    assert names_left_out(random.Random(seed).sample(given, len(given)), seed) == out


def test_in_time_each_is_drawn() -> None:
    out = [names_left_out(items(), seed) for seed in range(60)]
    assert set.intersection(*out) == set()


def test_in_the_benchmarks_none_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(EVERYTHING, "1")
    assert names_left_out(items(), 1) == set()

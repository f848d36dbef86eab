"""Readers of published instances: small ones here, and all that are in the data folder."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from benchmark_instances import DATA

from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.instances.numbers import InstanceError
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.problem import Window

LI_LIM = """\
2\t10\t1
0\t0\t0\t0\t0\t100\t0\t0\t0
1\t3\t4\t5\t0\t50\t9\t0\t2
2\t6\t8\t-5\t10\t90\t9\t1\t0
"""

TRANSFER = """\
nr nv nt capacity
1 1 1 7

node x y a b load
p0 0 0 0 10 3
d0 3 4 5 20 -3
o0 0 0 0 30 0
e0 6 8 0 30 0
t0 1 1 0 30 0
"""


def test_li_lim_depot_is_where_robots_start_and_end() -> None:
    problem = read_li_lim(LI_LIM, "tiny")
    assert [(r.start, r.end, r.capacity, r.shift) for r in problem.robots] == [
        (0, 0, 10.0, Window(0.0, 100.0))
    ] * 2
    (item,) = problem.items
    assert (item.load, item.pickup.place, item.delivery.place) == (5.0, 1, 2)
    assert item.delivery.window == Window(10.0, 90.0)
    assert item.pickup.service_s == 9.0
    assert problem.travel.time_s[0, 1] == 5.0


def test_transfer_benchmark_has_ends_and_transfer_places() -> None:
    problem = read_transfer_benchmark(TRANSFER, "tiny")
    (robot,) = problem.robots
    assert (problem.places[robot.start], robot.end, robot.capacity) == ("o0", 3, 7.0)
    assert [problem.places[place] for place in problem.transfers.places] == ["t0"]
    assert problem.items[0].pickup.window == Window(0.0, 10.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1: the first line"),
        (LI_LIM.replace("2\t6", "2\tsix"), "line 4: 'six' is no number"),
        (LI_LIM.replace("-5", "-4"), "line 3: the loads of 1 and 2 do not match"),
        (LI_LIM.replace("\t9\t1\t0", "\t9\t1"), "line 4: a node has 9 numbers, but here are 8"),
        (LI_LIM.replace("1\t3", "7\t3"), "line 3: node 1 is expected here, not 7"),
        ("1e19" + LI_LIM.lstrip("0123456789"), "line 1: there may be 0 to 1000 vehicles"),
    ],
)
def test_mistakes_in_a_li_lim_instance_are_told_with_their_line(text: str, words: str) -> None:
    with pytest.raises(InstanceError, match=words):
        read_li_lim(text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("nr nv", "line 1: the first line must be"),
        (TRANSFER.replace("t0", "t9"), "there is no node 't0'"),
        (TRANSFER.replace("20 -3", "inf -3"), "line 6: 'inf' is not finite"),
    ],
)
def test_mistakes_in_a_transfer_instance_are_told(text: str, words: str) -> None:
    with pytest.raises(InstanceError, match=words):
        read_transfer_benchmark(text)


def given_instances() -> Iterator[Path]:
    for folder in ("li_lim/pdp_100", "li_lim/pdp_200", "pdpt", "pdptwt"):
        yield from sorted((DATA / folder).glob("*.txt"))


@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
def test_all_given_instances_are_read() -> None:
    for path in given_instances():
        read = read_li_lim if "li_lim" in path.parts else read_transfer_benchmark
        problem = read(path.read_text(), path.stem)
        assert problem.items, path

"""Small delivery problems for tests of scheduling."""

import random
from dataclasses import replace
from math import inf

from hypothesis import strategies as st

from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.schedule import Action, Route, Task
from mend.fleet.scheduling.travel import Travel

CORRIDOR = ((0.0, 0.0), (10.0, 0.0), (20.0, 0.0), (30.0, 0.0), (40.0, 0.0))
"""Five places in a row, 10 m apart; robots drive 1 m/s."""

MIDDLE = Transfers((2,))


def corridor(
    *,
    items: tuple[Item, ...],
    robots: tuple[Robot, ...] = (Robot("left", 0, 0, 2.0), Robot("right", 4, 4, 2.0)),
    transfers: Transfers = MIDDLE,
) -> Problem:
    """Deliveries along a corridor; one robot at each end, one transfer place in the middle."""
    names = ("a", "b", "c", "d", "e")
    return Problem("corridor", names, Travel.euclidean(CORRIDOR), robots, items, transfers)


def parcel(name: str = "parcel", origin: int = 0, destination: int = 4, **fields: object) -> Item:
    """An item from place to place, without windows."""
    return Item(name, 1.0, Visit(origin), Visit(destination), **fields)  # type: ignore[arg-type]


HANDED_OVER: tuple[Route, ...] = (
    (Task(0, Action.PICK, 0), Task(2, Action.GIVE, 0, partner=1)),
    (Task(2, Action.TAKE, 0, partner=0), Task(4, Action.DROP, 0)),
)
"""The first robot brings item 0 to the middle of the corridor, the second one on from there."""

windows = st.tuples(st.integers(0, 60), st.integers(0, 200)).map(
    lambda pair: Window(float(pair[0]), float(pair[0] + pair[1]))
)


@st.composite
def corridor_items(draw: st.DrawFn) -> tuple[Item, ...]:
    """One to three items with random ends and windows."""
    place = st.integers(0, 4)
    return tuple(
        Item(
            f"item{number}",
            1.0,
            Visit(draw(place), draw(windows), service_s=float(draw(st.integers(0, 5)))),
            Visit(draw(place), draw(windows)),
        )
        for number in range(draw(st.integers(1, 3)))
    )


def drawn_problem(seed: int) -> Problem:
    """Two or three items in a corridor; windows, loads, ends and what counts differ by seed."""
    rng = random.Random(seed)

    def window() -> Window:
        if rng.random() < 0.5:
            return Window()
        begin_s = rng.randint(0, 60)
        return Window(float(begin_s), float(begin_s + rng.randint(60, 200)))

    items = [
        Item(
            f"item{number}",
            float(rng.randint(1, 2)),
            Visit(rng.randrange(5), window(), due_s=40.0, service_s=float(rng.randint(0, 3))),
            Visit(rng.randrange(5), window()),
            max_on_board_s=rng.choice((inf, 120.0)),
        )
        for number in range(rng.randint(2, 3))
    ]
    if rng.random() < 0.3:
        items[0] = replace(items[0], aboard=0)
    robots = tuple(
        Robot(f"robot{number}", place, rng.choice((place, None)), 2.0, Window(0.0, 300.0),
              speed=rng.choice((1.0, 2.0)))
        for number, place in enumerate((0, 4))
    )  # fmt: skip
    transfers = Transfers((2, 3), rng.random() < 0.3, float(rng.randint(0, 4)))
    weights = rng.choice(
        (Weights(), Weights(0.5, 1.0), Weights(1.0, 0.0, 0.5), Weights(1.0, 0.0, 0.0, 3.0, 20.0))
    )
    return replace(
        corridor(items=tuple(items), robots=robots, transfers=transfers), weights=weights
    )

"""Small delivery problems for tests of scheduling."""

from hypothesis import strategies as st

from fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from fleet.scheduling.schedule import Action, Route, Task
from fleet.scheduling.travel import Travel

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

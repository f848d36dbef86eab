"""What in the order of a task keeps things from being carried, or people from being escorted."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mend.documents.problem import list_names
from mend.robots.base.behaviors.collect_item import CollectItem
from mend.robots.base.behaviors.escort import Escort
from mend.robots.base.behaviors.hand_over_item import HandOverItem
from mend.robots.base.behaviors.meet_person import MeetPerson
from mend.sim.building.goods import MOST_ITEMS
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene_problem import SceneProblem

Nodes = Sequence[GoalNode | BehaviorNode]

_IN_BASKET = "/"
"""No place is called so."""
_ANYWHERE = ""
"""Where an item is that nobody has brought yet: at the first place where it is collected."""

Whereabouts = Mapping[str, frozenset[str]]
"""Where each item may be; one that is not in it is anywhere."""


@dataclass(frozen=True, slots=True)
class Errand:
    """What robots fetch with one behavior and bring with another, and how its mistakes are told.

    `of`: what a leaf handles. `stays`: it is where it was brought until it is fetched there.
    `handles`: what several children of an AND may not do. In the sentences `{leaf}` is a leaf's
    name, `{what}` what it handles, `{held}` what robots have, `{room}` for how many there is room.
    """

    fetch: str
    bring: str
    of: Callable[[BehaviorNode], str | None]
    stays: bool
    handles: str
    not_fetched: str
    fetched_already: str
    no_room: str


ITEMS = Errand(
    fetch=CollectItem.name,
    bring=HandOverItem.name,
    of=lambda leaf: leaf.item,
    stays=True,
    handles="carry",
    not_fetched="'{leaf}' hands over '{what}', which may not have been collected by then: put a "
    "collect_item of it before it in a THEN",
    fetched_already="'{leaf}' collects '{what}', which may be in a basket by then: put a "
    "hand_over_item of it in between",
    no_room="'{leaf}' collects '{what}' while robots carry {held}: there is room for {room} things "
    "in all baskets",
)
PEOPLE = Errand(
    fetch=MeetPerson.name,
    bring=Escort.name,
    of=lambda leaf: leaf.person,
    stays=False,
    handles="escort",
    not_fetched="'{leaf}' escorts '{what}', who may not have been met by then: put a meet_person "
    "with them before it in a THEN",
    fetched_already="'{leaf}' meets '{what}', whom a robot may lead by then: put an escort of them "
    "in between",
    no_room="'{leaf}' meets '{what}' while {held} may still be led: put their escort before it",
)


def check_items(nodes: Nodes, robots: int) -> list[SceneProblem]:
    """Leaves that hand over what was not collected, or collect what cannot be had or put in.

    The same of people, who are met and led one at a time. Leaves without a tree have no order, and
    are not checked.
    """
    if not nodes or (isinstance(nodes[0], BehaviorNode) and len(nodes) > 1):
        return []
    return [*_check(nodes, ITEMS, MOST_ITEMS * robots), *_check(nodes, PEOPLE, 1)]


def _check(nodes: Nodes, errand: Errand, room: int) -> list[SceneProblem]:
    if not any(isinstance(each, BehaviorNode) and errand.of(each) for each in nodes):
        return []
    return [*_without_order(nodes, errand), *_Order(nodes, errand, room).problems()]


def _without_order(nodes: Nodes, errand: Errand) -> Iterator[SceneProblem]:
    """What several children of one AND handle: in which order is open."""
    told: set[str] = set()
    handled: list[dict[str, str]] = [{} for _ in nodes]
    for index in range(len(nodes) - 1, -1, -1):
        node = nodes[index]
        if isinstance(node, BehaviorNode) and (what := errand.of(node)) is not None:
            handled[index][what] = node.place or ""
        if node.parent is None:
            continue
        above = handled[node.parent]
        twice = handled[index].keys() & above.keys() if nodes[node.parent].kind == "and" else ()
        for what in sorted(set(twice) - told):
            told.add(what)
            yield _problem(
                handled[index][what],
                f"several children of the AND '{nodes[node.parent].name}' {errand.handles} "
                f"'{what}', in any order: put them into one THEN",
            )
        above.update(handled[index])


@dataclass(slots=True)
class _Frame:
    """A goal node whose children are gone through."""

    index: int
    kind: str
    before: Whereabouts
    now: Whereabouts
    ends: list[Whereabouts] = field(default_factory=list)

    def begin(self) -> Whereabouts:
        """Where items may be when its next child begins."""
        return self.now if self.kind == "then" else self.before

    def take(self, after: Whereabouts) -> None:
        """A child has ended so."""
        match self.kind:
            case "then":
                self.now = after
            case "and":
                changed = {n: e for n, e in after.items() if self.before.get(n) != e}
                self.now = {**self.now, **changed}
            case _:
                self.ends.append(after)

    def end(self) -> Whereabouts:
        """Where items may be once it is done."""
        if self.kind != "or":
            return self.now
        names = {name for each in self.ends for name in each}
        nowhere = frozenset({_ANYWHERE})
        return {n: frozenset().union(*(e.get(n, nowhere) for e in self.ends)) for n in names}


class _Order:
    """Goes through a tree in its order, with where each item may be then."""

    def __init__(self, nodes: Nodes, errand: Errand, room: int) -> None:
        self._nodes, self._errand = nodes, errand
        self._room = room
        self._problems: dict[str, SceneProblem] = {}
        """By their sentences: each is told once."""

    def problems(self) -> list[SceneProblem]:
        """What is wrong, in the tree's order."""
        frames: list[_Frame] = []
        for index, node in enumerate(self._nodes):
            while frames and frames[-1].index != node.parent:
                ended = frames.pop().end()
                frames[-1].take(ended)
            before: Whereabouts = frames[-1].begin() if frames else {}
            if isinstance(node, GoalNode):
                frames.append(_Frame(index, node.kind, before, before))
                continue
            after = self._leaf(node, before)
            if frames:
                frames[-1].take(after)
        return list(self._problems.values())

    def _leaf(self, node: BehaviorNode, before: Whereabouts) -> Whereabouts:
        errand, what, place = self._errand, self._errand.of(node), node.place
        if what is None or place is None:
            return before
        at = before.get(what, frozenset({_ANYWHERE}))
        if node.behavior == errand.fetch:
            self._fetch(node, what, place, at, before)
            return {**before, what: frozenset({_IN_BASKET})}
        if node.behavior != errand.bring:
            return before
        if at != {_IN_BASKET}:
            self._tell(place, errand.not_fetched.format(leaf=node.name, what=what))
            # One mistake is told once, and not what follows from it.
            return {**before, what: frozenset({_ANYWHERE})}
        return {**before, what: frozenset({place})}

    def _fetch(
        self, node: BehaviorNode, what: str, place: str, at: frozenset[str], before: Whereabouts
    ) -> None:
        errand, leaf = self._errand, node.name
        if _IN_BASKET in at:
            self._tell(place, errand.fetched_already.format(leaf=leaf, what=what))
        elif errand.stays and (others := sorted(at - {_ANYWHERE, place})):
            self._tell(
                place,
                f"'{leaf}' collects '{what}' at '{place}', but by then it may be at "
                f"{list_names(others)}",
            )
        held = [name for name, where in before.items() if where == {_IN_BASKET} and name != what]
        if len(held) >= self._room:
            told = list_names(held)
            self._tell(
                place, errand.no_room.format(leaf=leaf, what=what, held=told, room=self._room)
            )

    def _tell(self, place: str, message: str) -> None:
        self._problems.setdefault(message, _problem(place, message))


def _problem(place: str, message: str) -> SceneProblem:
    return SceneProblem(("places", place), message)

"""What in the order of a task keeps things from being carried as its leaves say."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mend.documents.problem import list_names
from mend.robots.base.behaviors.collect_item import CollectItem
from mend.robots.base.behaviors.hand_over_item import HandOverItem
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


def check_items(nodes: Nodes, robots: int) -> list[SceneProblem]:
    """Leaves that hand over what was not collected, or collect what cannot be had or put in.

    Leaves without a tree have no order, and are not checked.
    """
    if not nodes or (isinstance(nodes[0], BehaviorNode) and len(nodes) > 1):
        return []
    if not any(isinstance(each, BehaviorNode) and each.item for each in nodes):
        return []
    return [*_without_order(nodes), *_Order(nodes, robots).problems()]


def _without_order(nodes: Nodes) -> Iterator[SceneProblem]:
    """Items that several children of one AND handle: in which order is open."""
    told: set[str] = set()
    handled: list[dict[str, str]] = [{} for _ in nodes]
    for index in range(len(nodes) - 1, -1, -1):
        node = nodes[index]
        if isinstance(node, BehaviorNode) and node.item is not None:
            handled[index][node.item] = node.place or ""
        if node.parent is None:
            continue
        above = handled[node.parent]
        twice = handled[index].keys() & above.keys() if nodes[node.parent].kind == "and" else ()
        for item in sorted(set(twice) - told):
            told.add(item)
            yield _problem(
                handled[index][item],
                f"several children of the AND '{nodes[node.parent].name}' carry '{item}', in any "
                "order: put them into one THEN",
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

    def __init__(self, nodes: Nodes, robots: int) -> None:
        self._nodes = nodes
        self._room = MOST_ITEMS * robots
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
        item, place = node.item, node.place
        if item is None or place is None:
            return before
        at = before.get(item, frozenset({_ANYWHERE}))
        match node.behavior:
            case CollectItem.name:
                self._collect(node, item, place, at, before)
                return {**before, item: frozenset({_IN_BASKET})}
            case HandOverItem.name:
                if at != {_IN_BASKET}:
                    self._tell(
                        place,
                        f"'{node.name}' hands over '{item}', which may not have been collected by "
                        f"then: put a {CollectItem.name} of it before it in a THEN",
                    )
                    # One mistake is told once, and not what follows from it.
                    return {**before, item: frozenset({_ANYWHERE})}
                return {**before, item: frozenset({place})}
            case _:
                return before

    def _collect(
        self, node: BehaviorNode, item: str, place: str, at: frozenset[str], before: Whereabouts
    ) -> None:
        if _IN_BASKET in at:
            self._tell(
                place,
                f"'{node.name}' collects '{item}', which may be in a basket by then: put a "
                f"{HandOverItem.name} of it in between",
            )
        elif others := sorted(at - {_ANYWHERE, place}):
            self._tell(
                place,
                f"'{node.name}' collects '{item}' at '{place}', but by then it may be at "
                f"{list_names(others)}",
            )
        held = [name for name, where in before.items() if where == {_IN_BASKET} and name != item]
        if len(held) >= self._room:
            self._tell(
                place,
                f"'{node.name}' collects '{item}' while robots carry {list_names(held)}: there is "
                f"room for {self._room} things in all baskets",
            )

    def _tell(self, place: str, message: str) -> None:
        self._problems.setdefault(message, _problem(place, message))


def _problem(place: str, message: str) -> SceneProblem:
    return SceneProblem(("places", place), message)

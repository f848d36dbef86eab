"""Making a plan hold again: what cannot hold together gives way and is sold again.

Only items whose constraints are in a conflict, or that the event took out, leave their routes; what
is under way and cannot be in time goes late; what has no place at all is put off with a sentence.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import inf

from mend.fleet.scheduling.auction import Sale, sell
from mend.fleet.scheduling.constraint import Constraint, ConstraintKind
from mend.fleet.scheduling.infeasibility import infeasibilities
from mend.fleet.scheduling.no_place import conflict_words, nearest_conflicts, no_place_words
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import items_in, part_schedule, without_items
from mend.fleet.scheduling.problem import Item, Problem, Window
from mend.fleet.scheduling.replanning.item_state import without_deadline
from mend.fleet.scheduling.schedule import Action, Route
from mend.fleet.scheduling.temporal_network import Conflict
from mend.fleet.scheduling.timing import TimedRoutes
from mend.fleet.scheduling.tolerance import LOAD, error

DEADLINES = (ConstraintKind.WINDOW_END, ConstraintKind.ON_BOARD)
ROBOT_LIMITS = (ConstraintKind.SHIFT_END, ConstraintKind.DURATION)
JUDGED_ALONE = 2
"""Up to how many items at once are also judged as if there were no other: it takes a while."""


class PlanRepair:
    """Routes that may not hold, and items to be sold; `repair` makes them hold.

    `held`: by robot, how many of its first tasks are what it does next. `late`, `put_off`: by item,
    why it goes late or has no place; `overtime`: by robot, why its shift is longer than it was.
    """

    def __init__(
        self,
        problem: Problem,
        routes: Sequence[Route],
        held: Sequence[int],
        under_way: Sequence[bool],
    ) -> None:
        self.problem = problem
        self.routes = list(routes)
        self.held = list(held)
        self.late: dict[int, str] = {}
        self.put_off: dict[int, str] = {}
        self.overtime: dict[int, str] = {}
        self._under_way = under_way
        self._asked = problem.items
        self._selling: dict[int, None] = {}
        self._begun: dict[int, int] = {}
        self._shift_ends_s: dict[int, float] = {}

    # --- what leaves the routes -------------------------------------------------------------------

    def resell(self, item: int) -> None:
        """Take an item out of the routes and sell it again.

        What a robot is about to pick up it still picks up; a transfer of the item falls through.
        """
        self._selling[item] = None
        for robot, route in enumerate(self.routes):
            if not any(task.item == item for task in route):
                continue
            first = route[0]
            keeps = self.held[robot] and first.item == item
            if keeps and first.action is Action.PICK:
                self._begun[item] = robot
                self.routes[robot] = (first, *without_items([route[1:]], {item})[0])
            else:
                self.held[robot] = 0 if keeps else self.held[robot]
                self.routes[robot] = without_items([route], {item})[0]

    # --- making it hold ---------------------------------------------------------------------------

    def repair(self) -> None:
        """Make the routes hold and sell what is to be sold."""
        self._give_way()
        self._end_overtime()
        pending = list(self._selling) or self._overload()
        while pending:
            self._place(pending)
            pending = self._overload()
            if pending:
                # Where others give way there may be room for what had none.
                pending += self.put_off
                self.put_off = {}

    def reconsider(self, items: Sequence[int]) -> None:
        """Sell items again that are in routes, where that makes the whole cheaper."""
        for item in items:
            if not self._free(item) or item in self.put_off:
                continue
            others = without_items(self.routes, {item})
            sale = sell(self.problem, others, (item,), held=self.held)
            now = self._cost(Sale(tuple(self.routes)))
            if not sale.unsold and self._cost(sale) < now - error(now):
                self.routes = list(sale.routes)

    def _place(self, items: Sequence[int]) -> None:
        """Sell items; what is under way goes late if it must, what has no place is put off."""
        left = self._sell(self._urgent_first(items))
        late = [item for item in left if self._under_way[item]]
        for item, why in self._reasons(late).items():
            self._go_late(item, why)
        if late:
            left = self._sell(self._urgent_first(left))
        left = self._sell_beyond_shifts(left)
        self.put_off.update(self._reasons(left))
        for item in left:
            # Its time counts again: there may be room for it after all, and then it is in time.
            if self.late.pop(item, None) is not None:
                self._describe(item, self._asked[item])
            self._drop_begun(item)

    def _overload(self) -> list[int]:
        """Take out an item for which there is no room any more, as another one stays on board."""
        for robot, route in enumerate(self.routes):
            capacity = self.problem.robots[robot].capacity
            load = sum(item.load for item in self.problem.items if item.aboard == robot)
            for task in route:
                load += self.problem.items[task.item].load * (1 if task.action.loads else -1)
                if task.action.loads and load > capacity + LOAD:
                    self._let_go(task.item)
                    return [task.item]
        return []

    def _give_way(self) -> None:
        """Take out or relax, one by one, what cannot hold together."""
        while True:
            conflict = self._timed().conflict
            if conflict is None:
                return
            self._yield_to(conflict)

    def _timed(self) -> TimedRoutes:
        whole = [item for item in items_in(self.routes) if item not in self._begun]
        return TimedRoutes(self.problem, self.routes, whole)

    def _yield_to(self, conflict: Conflict[Constraint]) -> None:
        """Resolve a conflict as gently as can be: items that nobody is about to do anything with,
        then what is about to be picked up, then deadlines, then shifts."""
        deadlines = self._items_of(conflict, DEADLINES)
        items = [*deadlines, *self._items_of(conflict, tuple(ConstraintKind))]
        free = next((item for item in items if self._free(item)), None)
        waiting = next((item for item in items if self._waits(item)), None)
        late = next((item for item in deadlines if item not in self.late), None)
        robots = [each.robot for each in conflict.reasons if each.robot is not None]
        limits = [each.robot for each in conflict.reasons if each.kind in ROBOT_LIMITS]
        longer = next((k for k in limits if k is not None and k not in self.overtime), None)
        if free is not None:
            self.resell(free)
        elif waiting is not None:
            self._let_go(waiting)
        elif late is not None:
            self._go_late(late, self._why(late, conflict))
        elif longer is not None:
            self._work_longer(longer, conflict_words(self.problem, conflict))
        else:
            on_routes = [task.item for k in robots for task in reversed(self.routes[k])]
            self._let_go([*items, *on_routes][0])

    def _items_of(
        self, conflict: Conflict[Constraint], kinds: Sequence[ConstraintKind]
    ) -> list[int]:
        return [
            each.task.item
            for each in conflict.reasons
            if each.task is not None and each.kind in kinds
        ]

    def _free(self, item: int) -> bool:
        """Whether nobody is about to do anything with it, and it is not sold again already."""
        return item not in self._selling and not any(
            held and route and route[0].item == item
            for held, route in zip(self.held, self.routes, strict=True)
        )

    def _waits(self, item: int) -> bool:
        """Whether it is about to be picked up for the first time."""
        return not self._under_way[item] and any(
            task.item == item for route in self.routes for task in route
        )

    def _let_go(self, item: int) -> None:
        """Sell an item again although a robot is about to do something with it."""
        self.resell(item)
        self._drop_begun(item)

    def _go_late(self, item: int, why: str) -> None:
        self.late[item] = why
        self._describe(item, without_deadline(self.problem.items[item]))

    def _describe(self, item: int, described: Item) -> None:
        items = list(self.problem.items)
        items[item] = described
        self.problem = replace(self.problem, items=tuple(items))

    def _sell_beyond_shifts(self, left: Sequence[int]) -> Sequence[int]:
        """Robots bring what they have on board, if need be after their shifts."""
        stuck = [item for item in left if self.problem.items[item].aboard is not None]
        for item, why in self._reasons(stuck).items():
            robot = self.problem.items[item].aboard
            assert robot is not None, "it is on board"
            if robot not in self.overtime:
                self._work_longer(robot, why)
        if not stuck:
            return left
        left = self._sell(self._urgent_first(left))
        self._end_overtime()
        return left

    def _work_longer(self, robot: int, why: str) -> None:
        self.overtime[robot] = why
        self._shift_ends_s[robot] = self.problem.robots[robot].shift.latest_s
        self._change_robot(robot, inf)

    def _end_overtime(self) -> None:
        """Robots that must work longer get no more to do than they have."""
        if not self.overtime:
            return
        timed = self._timed()
        for robot in list(self.overtime):
            ends_s = timed.network.earliest_s(timed.ends[robot])
            self._change_robot(robot, max(ends_s, self._shift_ends_s[robot]))
            if ends_s <= self._shift_ends_s[robot]:
                del self.overtime[robot]

    def _change_robot(self, robot: int, shift_ends_s: float) -> None:
        robots = list(self.problem.robots)
        shift = Window(robots[robot].shift.earliest_s, shift_ends_s)
        robots[robot] = replace(robots[robot], shift=shift, max_duration_s=inf)
        self.problem = replace(self.problem, robots=tuple(robots))

    # --- selling ----------------------------------------------------------------------------------

    def _sell(self, items: Sequence[int]) -> Sequence[int]:
        """Sell items, with transfers or without as is better; what is left over.

        Each way also with what had no place offered first.
        """
        if not items:
            return ()
        ways = (True, False) if self.problem.transfers.places and len(items) > 1 else (True,)
        sales: list[Sale] = []
        for way in ways:
            sale = self._auction(items, way)
            hard = [item for item in items if item in sale.unsold]
            easy = [item for item in items if item not in sale.unsold]
            sales.append(sale)
            if hard and easy:
                sales.append(self._auction(hard, way, easy))
        fewest = min(len(sale.unsold) for sale in sales)
        # Each cost takes a schedule of everything, so nothing is timed that has no rival.
        rivals = list(dict.fromkeys(sale for sale in sales if len(sale.unsold) == fewest))
        best = min(rivals, key=self._cost) if len(rivals) > 1 else rivals[0]
        self.routes = list(best.routes)
        self._begun = {item: k for item, k in self._begun.items() if item in best.unsold}
        return best.unsold

    def _auction(self, items: Sequence[int], transfers: bool, then: Sequence[int] = ()) -> Sale:
        begun = self._begun
        sale = sell(
            self.problem, self.routes, items, held=self.held, begun=begun, transfers=transfers
        )
        if not then:
            return sale
        begun = {item: k for item, k in begun.items() if item in then or item in sale.unsold}
        more = sell(
            self.problem, sale.routes, then, held=self.held, begun=begun, transfers=transfers
        )
        return Sale(more.routes, sale.unsold + more.unsold)

    def _cost(self, sale: Sale) -> float:
        timed = part_schedule(self.problem, without_items(sale.routes, sale.unsold))
        return inf if timed is None else cost(*timed).total

    def _urgent_first(self, items: Iterable[int]) -> list[int]:
        described = self.problem.items
        return sorted(
            items,
            key=lambda item: (
                not self._under_way[item],
                described[item].delivery.window.latest_s,
                item,
            ),
        )

    def _drop_begun(self, item: int) -> None:
        robot = self._begun.pop(item, None)
        if robot is not None:
            self.routes[robot] = without_items([self.routes[robot]], {item})[0]
            self.held[robot] = 0

    # --- why --------------------------------------------------------------------------------------

    def _reasons(self, items: Sequence[int]) -> dict[int, str]:
        """Why each of some items has no place in the routes as they are now."""
        conflicts = nearest_conflicts(self.problem, self.routes, items, self._begun)
        return {item: self._why(item, conflict) for item, conflict in conflicts.items()}

    def _why(self, item: int, conflict: Conflict[Constraint] | None) -> str:
        """One sentence: what cannot hold whatever the robots do, or beside what they have to do."""
        described = self.problem.items[item]
        if len(self._selling) <= JUDGED_ALONE:
            alone = replace(self.problem, items=(described,))
            for each in infeasibilities(alone):
                if each.item == 0:
                    return each.sentence
        return no_place_words(self.problem, item, conflict)

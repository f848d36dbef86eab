"""People as agents of one run: they take leaves, do them, or give them back."""

from collections.abc import Mapping
from math import dist

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.robots.link.messages import FinishedResult, Looked
from mend.server.journal import events as ev
from mend.server.runtime.clock import has_come
from mend.server.runtime.context import RunContext
from mend.server.runtime.leaf_words import LeafDeed, leaf_meant, understood
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.robot_proxy import Purpose, RobotActivity, RobotProxy
from mend.server.runtime.team import Team
from mend.server.runtime.views import LeafSaid
from mend.tasks.definition import BehaviorNode, NodeKind

AS_FAST_AS_PEOPLE = 1.0
"""While robots only wait for people a simulated clock runs as theirs does."""

MOVED_M = 0.02
"""What was nearer to its place than that when somebody took its leaf was there already."""


class People:
    """Who of the people has which leaf of a run."""

    def __init__(
        self,
        context: RunContext,
        proxies: Mapping[str, RobotProxy],
        reports: ReportEvents,
        team: Team,
    ) -> None:
        self._context = context
        self._proxies = proxies
        self._reports = reports
        self._team = team

    # --- What they say ------------------------------------------------------------------------

    async def take(self, node: str, helper: str, author: ev.Author | None = None) -> None:
        """A person does a leaf themselves; until they have done it, it is no robot's.

        Raises `NotFoundError`, `WrongInputError`, or `ConflictError` where it cannot be begun now.
        """
        leaf = self.may_take(node)
        await self._context.commit([self._taken(leaf, helper, author)])

    async def say_done(
        self, node: str, helper: str, reason: str, author: ev.Author | None = None
    ) -> None:
        """A person says that they have done a leaf: a robot looks, and says what it sees.

        Raises as `take`.
        """
        leaf = self.may_take(node)
        said = {"said_done": True, "reason": reason}
        await self._context.commit([self._taken(leaf, helper, author).model_copy(update=said)])

    def may_take(self, node: str) -> int:
        """The leaf that a person may take now. Raises as `take`."""
        state = self._context.state
        leaf = self._leaf(node)
        definition = state.tree.leaf_definition(leaf)
        name = definition.name
        if definition.object is None or definition.place is None:
            raise WrongInputError(
                f"'{name}' cannot be taken: nobody could see it done, as it names no object "
                "and place"
            )
        if not state.tree.eligible(leaf):
            owner = state.tree.owner(leaf)
            why = f"{owner} is at it" if owner else "it is done, or its turn has not come"
            raise ConflictError(f"'{name}' cannot be taken now: {why}")
        busy = self._team.at_work_where(definition)
        if busy is not None:
            raise ConflictError(
                f"'{name}' cannot be taken now: the robot '{busy}' is at work there, wait until "
                "its arm rests"
            )
        return leaf

    def _taken(self, leaf: int, helper: str, author: ev.Author | None) -> ev.NodeTaken:
        return ev.NodeTaken(
            **self._context.stamp(),
            **self._reports.node(leaf),
            helper=helper,
            until=self._context.clock.now() + self._context.settings.person_leaf_s,
            was_at=self._seen_at(self._context.state.tree.leaf_definition(leaf)),
            author=author,
        )

    async def give_back(self, node: str, helper: str) -> None:
        """They do not do it after all. Raises `NotFoundError` or `ConflictError`."""
        leaf = self._leaf(node)
        taken = self._context.state.people.get(leaf)
        if taken is None or taken.helper != helper:
            name = self._context.state.tree.name_of(leaf)
            raise ConflictError(f"'{name}' is not {helper}'s to give back")
        await self._context.commit([self._reset(leaf, f"{helper} gives it back")])

    async def say(self, words: str, helper: str, author: ev.Author | None = None) -> LeafSaid:
        """Take a leaf, or give it back, in plain words. Raises as `take` and `give_back`."""
        said = understood(words)
        state = self._context.state
        node = state.tree.path_of(leaf_meant(said, helper, state.tree, state.people))
        if said.deed is LeafDeed.TAKE:
            await self.take(node, helper, author)
        else:
            await self.give_back(node, helper)
        return LeafSaid(
            deed=said.deed, node=node, name=state.tree.name_of(state.tree.index_of(node))
        )

    def _leaf(self, node: str) -> int:
        tree = self._context.state.tree
        leaf = tree.index_of(node)
        if tree.kind_of(leaf) is not NodeKind.BEHAVIOR:
            raise NotFoundError(f"'{node}' is no behavior: only those can be taken")
        return leaf

    def _reset(self, leaf: int, reason: str) -> ev.NodeReset:
        return self._reports.reset(leaf, None, reason, failed=False)

    # --- What is seen of it -------------------------------------------------------------------

    def results(self) -> list[FinishedResult]:
        """What there is to see once they have done what they took."""
        return list(self._awaited())

    def _awaited(self) -> dict[FinishedResult, int]:
        tree = self._context.state.tree
        found = {}
        for leaf in self._context.state.people:
            definition = tree.leaf_definition(leaf)
            assert definition.object is not None, "what was taken can be seen done"
            assert definition.place is not None, "what was taken can be seen done"
            found[FinishedResult(object=definition.object, place=definition.place)] = leaf
        return found

    def watch(self, proxy: RobotProxy) -> None:
        """Have a robot that has nothing else to do look for what a person took first."""
        people = self._context.state.people
        watching = proxy.doing is RobotActivity.LOOKING and proxy.purpose is Purpose.PERSON
        if not people or watching:
            return
        leaf, taken = min(people.items(), key=lambda each: each[1].until)
        definition = self._context.state.tree.leaf_definition(leaf)
        proxy.look(
            Purpose.PERSON,
            object=definition.object,
            place=definition.place,
            expect="at_place",
            within_s=self._looked_for_s(taken),
            rate=AS_FAST_AS_PEOPLE,
        )

    def _looked_for_s(self, taken: ev.NodeTaken) -> float:
        left_s = max(0.0, taken.until - self._context.clock.now())
        return min(left_s, self._context.settings.help_window_s) if taken.said_done else left_s

    async def judged(self, proxy: RobotProxy, looked: Looked) -> None:
        """Take what a look says of the results that people were to bring about."""
        awaited = self._awaited()
        done = [awaited[each] for each in looked.there if each in awaited]
        unseen = [awaited[each] for each in looked.gone if each in awaited]
        said = self._context.state.people
        back = [leaf for leaf in unseen if said[leaf].said_done]
        events: list[ev.Event] = [self._done(leaf, proxy) for leaf in done]
        events += [self._reset(leaf, _why_not_done(said[leaf])) for leaf in back]
        if events:
            await self._context.commit(events)

    def _done(self, leaf: int, proxy: RobotProxy) -> ev.NodeDone:
        state = self._context.state
        taken = state.people[leaf]
        place = state.scene.places.get(state.tree.leaf_definition(leaf).place or "")
        was_there = (
            taken.was_at is not None
            and place is not None
            and dist(taken.was_at[:2], (place.pose.x, place.pose.y)) < MOVED_M
        )
        return ev.NodeDone(
            **self._context.stamp(),
            **self._reports.node(leaf),
            robot=proxy.robot,
            by="found" if was_there and not taken.said_done else "human",
        )

    def _seen_at(self, leaf: BehaviorNode) -> tuple[float, float, float] | None:
        seen = [
            (each.seen_at, each.seen[leaf.object])
            for each in self._proxies.values()
            if leaf.object in each.seen
        ]
        if not seen:
            return None
        _, at = max(seen, key=lambda each: each[0])
        return at.x, at.y, at.z

    # --- Their time ---------------------------------------------------------------------------

    def next_due(self) -> float | None:
        """When (the run's clock) the first of them has had their time."""
        return min((each.until for each in self._context.state.people.values()), default=None)

    async def expire(self) -> bool:
        """Give back what somebody has not done in their time; True if there was anything."""
        due = [
            (leaf, each)
            for leaf, each in self._context.state.people.items()
            if has_come(self._context.clock, each.until)
        ]
        resets = [self._reset(leaf, _why_not_done(each)) for leaf, each in due]
        if resets:
            await self._context.commit(resets)
        return bool(resets)


def _why_not_done(taken: ev.NodeTaken) -> str:
    if taken.said_done:
        return f"{taken.helper} said that it was done, but no robot has seen it at its place"
    return f"{taken.helper} has not done it in time"

"""The check of a whole scene: each part by itself, and what gets in each other's way."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from robots.feasibility.doing import ArmCheck, FindNoWay, Surroundings
from robots.feasibility.handling import cannot_handle
from robots.feasibility.standing import Standing, at_place, beneath, starts
from robots.feasibility.support import cannot_stand
from robots.gripper import GripperModel
from tasks.definition import BehaviorNode, GoalNode
from tasks.leaf_order import LeafOrder
from tasks.scene import Scene
from tasks.scene_problem import SceneProblem


@dataclass(frozen=True, slots=True)
class Job:
    """One part that is to be taken from where it starts to a place, by leaf number `leaf`."""

    leaf: int
    start: Standing
    place: Standing | None

    @property
    def name(self) -> str:
        return self.start.name


def check_scene(
    scene: Scene,
    nodes: Sequence[GoalNode | BehaviorNode],
    gripper: GripperModel,
    no_way: FindNoWay,
) -> list[SceneProblem]:
    """What keeps a robot from doing the leaves among `nodes`; without any, each part by itself.

    Of a whole tree (with its goal nodes) the order and the alternatives are taken into account;
    of leaves alone all are done, in any order. Each part is told of once.
    """
    return _SceneCheck(scene, nodes, gripper, no_way).problems()


class _SceneCheck:
    def __init__(
        self,
        scene: Scene,
        nodes: Sequence[GoalNode | BehaviorNode],
        gripper: GripperModel,
        no_way: FindNoWay,
    ) -> None:
        self._scene = scene
        self._gripper = gripper
        self._arm = ArmCheck(gripper, no_way, scene.scatter, scene.table)
        self._order = LeafOrder(nodes)
        self._starts = starts(scene)
        self._jobs = _jobs(scene, self._order, self._starts)
        self._together = bool(nodes)

    def problems(self) -> list[SceneProblem]:
        """The plain mistakes first; what follows from one is not told as well."""
        found = [*self._handling(), *self._standing(), *self._overlaps()]
        return [*found, *self._doing(_Told(found))]

    def _handling(self) -> list[SceneProblem]:
        names = dict.fromkeys(job.name for job in self._jobs)
        objects = self._scene.objects
        return [p for name in names for p in cannot_handle(name, objects[name], self._gripper)]

    def _standing(self) -> list[SceneProblem]:
        found: dict[tuple[str, ...], SceneProblem] = {}
        standing = list(self._starts.values())
        for each in standing:
            for problem in cannot_stand(each, standing, self._scene):
                found.setdefault(problem.where, problem)
        for job in self._jobs:
            if job.place is None:
                continue
            others = [each.place for each in self._jobs if each.place and each is not job]
            unmoved = [each for each in standing if each.name != job.name]
            for problem in cannot_stand(job.place, [*others, *unmoved], self._scene):
                found.setdefault(problem.where, problem)
        return list(found.values())

    def _overlaps(self) -> list[SceneProblem]:
        found = [
            SceneProblem(
                two.where,
                f"{two.name} and {one.name} start in one spot, at ({two.pose.x:.3f}, "
                f"{two.pose.y:.3f}): move one of them",
            )
            for one, two in combinations(self._starts.values(), 2)
            if one.meets(two)
        ]
        if not self._together:
            return found
        for first, second in combinations(self._jobs, 2):
            one, two = first.place, second.place
            if one is None or two is None or first.name == second.name or one.where == two.where:
                continue
            if not self._order.exclusive(first.leaf, second.leaf) and one.meets(two):
                message = (
                    f"at their places {two.name} and {one.name} would be inside each other: move "
                    "one of the places"
                )
                found.append(SceneProblem(two.where, message))
        moved = {job.name for job in self._jobs}
        for job in self._jobs:
            for each in self._starts.values():
                if job.place and each.name not in moved and job.place.meets(each):
                    message = (
                        f"the place of {job.name} is where {each.name} stands, which nothing takes "
                        "away: move one of them"
                    )
                    found.append(SceneProblem(job.place.where, message))
        return found

    def _doing(self, told: "_Told") -> list[SceneProblem]:
        found = []
        for job in self._jobs:
            if told.of(job.start) or (job.place is not None and told.of(job.place)):
                continue
            around = Surroundings(self._around_start(job), self._around_place(job))
            problem = self._arm.cannot_do(job.start, job.place, around)
            if problem is not None:
                found.append(problem)
        return list(dict.fromkeys(found))

    def _around_start(self, job: Job) -> list[Standing]:
        """What may stand around a part when it is taken: not what is taken off it before."""
        others = [each for each in self._starts.values() if each.name != job.name]
        above = _resting_on(job.start, others)
        gone = {each.name for each in self._jobs if self._order.is_before(each.leaf, job.leaf)}
        # What stands in the same spot was told of already.
        waiting = [
            each
            for each in others
            if each not in above and each.name not in gone and not job.start.meets(each)
        ]
        return [*waiting, *(each for each in self._filled(job) if not job.start.meets(each))]

    def _filled(self, job: Job) -> list[Standing]:
        """The places of other parts that may be filled while a part is handled."""
        if not self._together:
            return []
        return [
            each.place
            for each in self._jobs
            if each.name != job.name
            and each.place is not None
            and not self._order.exclusive(each.leaf, job.leaf)
            and not self._order.is_before(job.leaf, each.leaf)
        ]

    def _around_place(self, job: Job) -> list[Standing]:
        """What may stand around a place when it is filled: not what is put onto it later."""
        if job.place is None:
            return []
        rivals = [each for each in self._jobs if each.name != job.name] if self._together else []
        places = [
            each
            for each in self._filled(job)
            if each.where != job.place.where and not job.place.meets(each)
        ]
        above = _resting_on(job.place, places)
        gone = {each.name for each in rivals if self._order.is_before(each.leaf, job.leaf)}
        waiting = [
            each
            for each in self._starts.values()
            if each.name != job.name and each.name not in gone and not job.place.meets(each)
        ]
        return [*(each for each in places if each not in above), *waiting]


class _Told:
    """What problems were told of already."""

    def __init__(self, found: Sequence[SceneProblem]) -> None:
        self._where = {each.where[:2] for each in found}

    def of(self, standing: Standing) -> bool:
        return standing.where[:2] in self._where


def _jobs(scene: Scene, order: LeafOrder, where: dict[str, Standing]) -> list[Job]:
    """What the leaves do; without leaves, every part to the place that is called like it."""
    leaves = order.leaves
    if not leaves:
        return [
            Job(number, start, at_place(scene, name, name) if name in scene.places else None)
            for number, (name, start) in enumerate(where.items())
        ]
    return [
        Job(
            index,
            where[leaf.object],
            at_place(scene, leaf.object, leaf.place) if leaf.place in scene.places else None,
        )
        for index, leaf in leaves
        if leaf.object in where and leaf.object is not None
    ]


def _resting_on(lowest: Standing, others: Sequence[Standing]) -> list[Standing]:
    """All that stands on a part, directly or by way of others."""
    found: list[Standing] = []
    layer = [lowest]
    while layer:
        layer = [
            each
            for each in others
            if each not in found and any(one in layer for one in beneath(each, layer))
        ]
        found += layer
    return found

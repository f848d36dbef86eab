"""The check of a whole scene: each part by itself, and what gets in each other's way."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, product

from mend.robots.arm.behaviors.grasp_choice import Crowding
from mend.robots.arm.behaviors.planning import Planner
from mend.robots.arm.feasibility.burdens import Burdens
from mend.robots.arm.feasibility.doing import ArmCheck, Hindrance
from mend.robots.arm.feasibility.handling import cannot_handle
from mend.robots.arm.feasibility.merging import one_surface
from mend.robots.arm.feasibility.moments import Job, Moment, Moments
from mend.robots.arm.feasibility.sight import hidden, out_of_picture
from mend.robots.arm.feasibility.standing import Standing, at_place, resting_on, starts
from mend.robots.arm.feasibility.strewn import StrewnPart, told_together
from mend.robots.arm.feasibility.support import cannot_stand
from mend.robots.vision.viewpoint import Viewpoint
from mend.tasks.alternatives import MOST_COMPARED_LEAVES, distinct_alternatives
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

_MOST_SPLITS = 3
"""So many things that may or may not stand around are looked at by themselves; where more of them
bar the way only together, nothing is said."""


def check_scene(
    scene: Scene,
    nodes: Sequence[GoalNode | BehaviorNode],
    planner: Planner,
    head: Viewpoint,
) -> list[SceneProblem]:
    """What keeps a robot from doing the leaves among `nodes`; without any, each part by itself.

    `head` is its head camera. Of a whole tree (with its goal nodes) the order and the alternatives
    are taken into account; of leaves alone all are done, in any order. Without any, what could be
    taken away before a part does not count. Each part is told of once. Trees of more than
    `MOST_COMPARED_LEAVES` leaves are not checked.
    """
    return check_for_robots(scene, nodes, [CheckedRobot(scene, planner, head)], _everybody)


@dataclass(frozen=True, slots=True)
class CheckedRobot:
    """A robot that may do it: the scene as it has it, its planner and its head camera."""

    scene: Scene
    planner: Planner
    head: Viewpoint


Asked = Callable[[str, str | None], Sequence[int]]
"""Which of the robots are asked, by their numbers, about an object and its place, one by one until
one of them can do it."""


def check_for_robots(
    scene: Scene,
    nodes: Sequence[GoalNode | BehaviorNode],
    robots: Sequence[CheckedRobot],
    asked: Asked,
) -> list[SceneProblem]:
    """As `check_scene`, for robots of one kind: what one of them can do is no problem."""
    distinct = distinct_alternatives(nodes).nodes
    if sum(node.kind == "behavior" for node in distinct) > MOST_COMPARED_LEAVES:
        return []
    return _SceneCheck(scene, distinct, robots, asked).problems()


def _everybody(_object: str, _place: str | None) -> Sequence[int]:
    return (0,)


class _SceneCheck:
    def __init__(
        self,
        scene: Scene,
        nodes: Sequence[GoalNode | BehaviorNode],
        robots: Sequence[CheckedRobot],
        asked: Asked,
    ) -> None:
        self._scene = scene
        self._asked = asked
        self._gripper = robots[0].planner.gripper
        self._order = LeafOrder(nodes)
        self._starts = starts(scene)
        self._jobs = _jobs(scene, self._order, self._starts)
        self._together = bool(nodes)
        self._robots = [_RobotCheck(each, self._order, self._together) for each in robots]

    def problems(self) -> list[SceneProblem]:
        """The plain mistakes first; what follows from one is not told as well."""
        found = [*self._handling()]
        found += [*self._standing(_ToldProblems(found)), *self._overlaps(), *self._merging()]
        return _each_once([*found, *self._doing(_ToldProblems(found))])

    def _handling(self) -> list[SceneProblem]:
        names = dict.fromkeys(job.name for job in self._jobs)
        objects = self._scene.objects
        return [p for name in names for p in cannot_handle(name, objects[name], self._gripper)]

    def _standing(self, told: "_ToldProblems") -> list[SceneProblem]:
        found: dict[tuple[str, ...], SceneProblem] = {}
        wanted: list[tuple[Standing, Job | None]] = [
            (each, None) for each in self._starts.values() if not told.of(each)
        ]
        wanted += [(job.place, job) for job in self._jobs if job.place and not told.of(job.start)]
        for standing, job in wanted:
            for problem in cannot_stand(standing, self._around(standing, job), self._scene):
                found.setdefault(problem.where, problem)
        return list(found.values())

    def _around(self, standing: Standing, job: Job | None) -> Sequence[Standing]:
        """What else stands there when a part stands least firmly; `job` is what places it.

        Without leaves anything may be brought under a place, and nothing onto it.
        """
        if self._together:
            return self._burdens.around(standing, job)
        if job is None:
            return list(self._starts.values())
        others = [
            each
            for each in self._anywhere
            if each.name != standing.name and each.where != standing.where
        ]
        above = resting_on(standing, others)
        return [each for each in others if each not in above]

    @cached_property
    def _burdens(self) -> Burdens:
        weights = {name: each.mass_kg for name, each in self._scene.objects.items()}
        return Burdens(self._jobs, list(self._starts.values()), self._order, weights)

    @cached_property
    def _anywhere(self) -> list[Standing]:
        """Every part where it starts, and at every place."""
        scene = self._scene
        return [
            *self._starts.values(),
            *(at_place(scene, *each) for each in product(scene.objects, scene.places)),
        ]

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

    def _merging(self) -> list[SceneProblem]:
        jobs = self._jobs if self._together else []
        return list(one_surface(self._scene, list(self._starts.values()), jobs, self._order))

    def _doing(self, told: "_ToldProblems") -> list[SceneProblem]:
        jobs = [
            job
            for job in self._jobs
            if not (told.of(job.start) or (job.place is not None and told.of(job.place)))
        ]
        if not self._together:
            return self._in_no_order(jobs)
        moved = {each.name for each in self._jobs}
        found = [self._problem(job, None, moved) for job in jobs]
        return [each for each in found if each is not None]

    def _in_no_order(self, jobs: Sequence[Job]) -> list[SceneProblem]:
        """What is wrong with the parts that cannot be taken, whatever was taken away before."""
        left, waiting = list(range(len(self._jobs))), list(jobs)
        while True:
            stuck = {}
            for job in waiting:
                problem = self._problem(job, left, moved=set())
                if problem is None:
                    left.remove(self._jobs.index(job))
                else:
                    stuck[job] = problem
            if len(stuck) == len(waiting):
                return list(stuck.values())
            waiting = list(stuck)

    def _problem(
        self, job: Job, left: Sequence[int] | None, moved: set[str]
    ) -> SceneProblem | None:
        """What keeps the first robot that is asked from a job, where no other can do it either."""
        number = self._jobs.index(job)
        place = None if job.place is None else job.place.where[1]
        first: SceneProblem | None = None
        for robot in self._asked(job.name, place):
            problem = self._robots[robot].problem(number, left, moved)
            if problem is None:
                return None
            first = first or problem
        return first


class _RobotCheck:
    """What one robot can do, all of it in its base frame."""

    def __init__(self, robot: CheckedRobot, order: LeafOrder, together: bool) -> None:
        scene = robot.scene
        self._head = robot.head
        self._scatter = scene.scatter
        self._arm = ArmCheck(robot.planner, scene.scatter, scene.table)
        self._order = order
        begin = starts(scene)
        self._jobs = _jobs(scene, order, begin)
        self._moments = Moments(self._jobs, list(begin.values()), order, together=together)

    def problem(
        self, number: int, left: Sequence[int] | None, moved: set[str]
    ) -> SceneProblem | None:
        """What keeps it from a job; `moved` are the parts that leaves take away.

        With `left` only the starts of these jobs are still there, and there is no order.
        """
        if left is None:
            return self._problem(self._jobs[number], self._moments, moved)
        jobs = [self._jobs[each] for each in left]
        moments = Moments(jobs, [each.start for each in jobs], self._order, together=False)
        return self._problem(self._jobs[number], moments, moved)

    def _problem(self, job: Job, moments: Moments, moved: set[str]) -> SceneProblem | None:
        sure, _ = moments.around(moments.of(job))
        if (problem := hidden(job.start, sure, self._head.eye, moved)) is not None:
            return problem
        if (hindrance := self._hindrance(job, moments)) is not None:
            return self._with_order(self._arm.told(hindrance, moved), hindrance, job, moments)
        return out_of_picture(job, self._head, self._scatter)

    def _with_order(
        self, problem: SceneProblem, hindrance: Hindrance, job: Job, moments: Moments
    ) -> SceneProblem:
        """What is told of too little room, and which THEN would do as well, if one would."""
        if isinstance(problem, StrewnPart) or not isinstance(hindrance.barred.reason, Crowding):
            return problem
        sure, maybe = moments.around(moments.of(job))
        for each in maybe:
            others = [other for other in (*sure, *maybe) if other is not each]
            in_the_way = each.name in hindrance.names
            if in_the_way and self._arm.hindrance(job.start, job.place, others) is None:
                taken_away = each.where[0] == "objects"
                first, later = (each, job) if taken_away else (job, each)
                order = f"or put '{first.name}' before '{later.name}' in a THEN"
                return replace(problem, message=f"{problem.message}, {order}")
        return problem

    def _hindrance(self, job: Job, moments: Moments) -> Hindrance | None:
        """What keeps the arm from a job at a moment that the order allows; None if nothing does."""
        moment = moments.of(job)
        sure, maybe = moments.around(moment)
        # What is possible amid all that may ever stand around is possible at any moment.
        found = self._arm.hindrance(job.start, job.place, [*sure, *maybe])
        if found is None or not maybe:
            return found
        return self._at_some_moment(moment, found, _MOST_SPLITS)

    def _at_some_moment(self, moment: Moment, amid_all: Hindrance, splits: int) -> Hindrance | None:
        """As `_hindrance`, where there is one amid all that may stand around."""
        job = moment.job
        sure, maybe = self._moments.around(moment)
        found = self._arm.hindrance(job.start, job.place, sure)
        if found is not None or not maybe:
            return found
        if len(maybe) < len(amid_all.around) - len(sure):
            again = self._arm.hindrance(job.start, job.place, [*sure, *maybe])
            if again is None:
                return None
            amid_all = again
        if splits == 0:
            return None
        suspect = next((each for each in maybe if each.name in amid_all.names), maybe[0])
        for each in self._moments.split(moment, suspect):
            found = self._at_some_moment(each, amid_all, splits - 1)
            if found is not None:
                return found
        return None


def _each_once(found: Sequence[SceneProblem]) -> list[SceneProblem]:
    """The parts that the scatter puts out of the arm's way are told together.

    What else is wrong with the scatter, which all parts have in common, is told of one of them.
    """
    strewn = [each for each in found if isinstance(each, StrewnPart)]
    rest = [each for each in dict.fromkeys(found) if not isinstance(each, StrewnPart)]
    of_scatter = [each for each in rest if each.where[0] == "scatter"]
    once = [each for each in rest if each.where[0] != "scatter" or each is of_scatter[0]]
    return [*once, *told_together(strewn)]


class _ToldProblems:
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

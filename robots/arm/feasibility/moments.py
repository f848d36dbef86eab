"""When a part may be handled: what has been brought to its place by then, and what has not."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.robots.arm.feasibility.standing import Standing, resting_on
from mend.tasks.leaf_order import LeafOrder


@dataclass(frozen=True, slots=True)
class Job:
    """One part that is to be taken from where it starts to a place, by leaf number `leaf`."""

    leaf: int
    start: Standing
    place: Standing | None

    @property
    def name(self) -> str:
        return self.start.name


@dataclass(frozen=True, slots=True)
class Moment:
    """While a job is done: which leaves are done by then, and which are not; of others either."""

    job: Job
    done: frozenset[int]
    waiting: frozenset[int]


class Moments:
    """The moments that the order of a tree allows."""

    def __init__(
        self, jobs: Sequence[Job], starts: Sequence[Standing], order: LeafOrder, *, together: bool
    ) -> None:
        """`together`: all jobs are done, and not each part by itself."""
        self._jobs = jobs
        self._starts = starts
        self._order = order
        self._together = together

    def of(self, job: Job) -> Moment:
        """What is sure whenever a job is done."""
        others = [each.leaf for each in self._jobs if each.leaf != job.leaf]
        if not self._together:
            return Moment(job, frozenset(), frozenset(others))
        order = self._order
        done = {each for each in others if order.is_before(each, job.leaf)}
        waiting = {
            each
            for each in others
            if order.is_before(job.leaf, each, surely=False) or order.exclusive(each, job.leaf)
        }
        return Moment(job, frozenset(done), frozenset(waiting))

    def around(self, moment: Moment) -> tuple[list[Standing], list[Standing]]:
        """What surely stands around the job's part and place, and what else may.

        What is on top of the part is taken off it before, and what is to be on top of its place is
        put there later; what is in the same spot is another mistake.
        """
        job = moment.job
        spots = [job.start] if job.place is None else [job.start, job.place]
        others = [each for each in self._jobs if each.name != job.name]
        places = [
            each.place
            for each in others
            if each.place is not None and each.leaf not in moment.waiting
        ]
        done = {each.name for each in others if each.leaf in moment.done}
        starts = [each for each in self._starts if each.name != job.name and each.name not in done]
        above = resting_on(job.start, starts)
        if job.place is not None:
            places = [each for each in places if each.where != spots[-1].where]
            above += resting_on(job.place, places)
        standing = [
            each
            for each in (*starts, *places)
            if each not in above and not any(spot.meets(each) for spot in spots)
        ]
        open_places = {each.place for each in others if self._is_open(each, moment)}
        open_names = {each.name for each in others if self._is_open(each, moment)}
        maybe = [
            each
            for each in standing
            if (each in open_places if each in places else each.name in open_names)
        ]
        return [each for each in standing if each not in maybe], maybe

    def split(self, moment: Moment, standing: Standing) -> list[Moment]:
        """The moment with something that may stand there, and without."""
        leaves = [each for each in self._jobs if each.name == standing.name]
        job = next(
            each
            for each in leaves
            if self._is_open(each, moment) and standing in (each.start, each.place)
        )
        moments = [self._after(moment, job), self._before(moment, job)]
        there = moments if standing == job.place else moments[::-1]
        return [each for each in there if each is not None]

    def _is_open(self, job: Job, moment: Moment) -> bool:
        return job.leaf not in moment.done and job.leaf not in moment.waiting

    def _after(self, moment: Moment, job: Job) -> Moment | None:
        """The moment with a job done by then; None if that cannot be."""
        order = self._order
        leaves = [each.leaf for each in self._jobs]
        more = {each for each in leaves if order.is_before(each, job.leaf)} | {job.leaf}
        done = moment.done | more
        less = {each for each in leaves if any(order.exclusive(each, one) for one in more)}
        waiting = moment.waiting | less
        return None if done & waiting else Moment(moment.job, done, waiting)

    def _before(self, moment: Moment, job: Job) -> Moment | None:
        """The moment with a job not done by then; None if that cannot be."""
        leaves = [each.leaf for each in self._jobs]
        more = {each for each in leaves if self._order.is_before(job.leaf, each)} | {job.leaf}
        waiting = moment.waiting | more
        return None if moment.done & waiting else Moment(moment.job, moment.done, waiting)

"""Finding a lost robot again: what it saw since, laid over the map."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, product
from math import cos, exp

import numpy as np

from mend.localization.distance_field import DistanceField
from mend.localization.enml.anywhere import Anywhere
from mend.localization.enml.episode import Episode
from mend.localization.enml.global_search import GlobalSearch, Region, distinct, same_place
from mend.localization.enml.looks import Looks, glances, log_likelihoods, looks_of
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.polishing import GATES_M, polish
from mend.localization.enml.problem import Floats
from mend.localization.enml.work import Work, done, pieces
from mend.localization.pose import Poses, compose, relative, transform
from mend.maps.segment_grid import SegmentGrid

_THINNED_M = 0.25
_CANDIDATES = 4000
"""So many places of the lattice are glanced at with a few beams..."""
_BEAMS_GLANCED = 60
_CLIMBERS = 300
"""... the best of them moved to where the points fit, and weighed by two scans..."""
_NEAR = 40
"""... and so many near where the robot is followed, too..."""
_FIRST_GATES_M = np.array([0.6, 0.4, 0.25])
_LAST_GATES_M = np.array([0.25, 0.15, 0.15])
_AROUND_M = (-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6)
"""How far from where points have been moved to they may fit still better."""
_LEAST_FINALISTS, _MOST_FINALISTS = 40, 240
_IN_THE_RUNNING = 12.0
"""... and the best of those polished and weighed by more: many where many look much the same."""
_SCANS_POLISHED = 3
_SCANS_WEIGHED = 6
_LEAST_DOUBT = 0.5
"""The share of the lead that is always needed, and all that is where the robot is followed."""
_PIECES = 8
"""So many pieces of work an update does..."""
_RAYS_PER_PIECE_M = 850_000.0
"""... of so many metres of rays over the map, two or three milliseconds..."""
_RAY_BEGINS_M = 20.0
"""... and a ray takes as long as if it were so much longer (ours: on 12 maps)."""

MayBeAt = Callable[[float, float], bool]
"""Whether the robot may be at a point of the map at all, x and y in metres."""


@dataclass(frozen=True, slots=True)
class Found:
    """A place for the newest pose, and what speaks for it."""

    pose: Poses
    score: float
    """Log-likelihood per scan, over that of a robot that may be anywhere."""


class Recovery:
    """Searches a map for where the newest pose of an episode may be.

    Places that one search leaves open are weighed again by the next, with what was seen since.
    """

    def __init__(
        self,
        everywhere: Region,
        field: DistanceField,
        grid: SegmentGrid,
        anywhere: Anywhere,
        parameters: EnmlParameters,
        may_be_at: MayBeAt | None = None,
    ) -> None:
        self._may_be_at = may_be_at
        self._everywhere = everywhere
        self._lattice = GlobalSearch(field)
        self._grid = grid
        self._anywhere = anywhere
        self._parameters = parameters
        self._cos_max_angle = cos(parameters.max_angle_rad)
        self.forget()

    def forget(self) -> None:
        """Begin anew: the robot may be elsewhere than all places so far."""
        self._open: Floats = np.zeros((0, 3))
        self._won: Poses | None = None
        self._suspects = False
        self.stop()

    def stop(self) -> None:
        """Give up the search that goes on, but not the places that those before left open."""
        self._work: Work[Found | None] | None = None
        self._since = np.zeros(3)

    def move(self, motion: Poses) -> None:
        """Let the open places come along with the robot."""
        self._since = compose(self._since, motion)
        if len(self._open):
            self._open = compose(self._open, motion)
        if self._won is not None:
            self._won = compose(self._won, motion)

    @property
    def is_searching(self) -> bool:
        """Whether a search goes on."""
        return self._work is not None

    @property
    def is_wrong(self) -> float:
        """How probable it is at first that a place which was found is not the right one."""
        return 1.0 / (1.0 + exp(self._least_lead))

    @property
    def _least_lead(self) -> float:
        return _LEAST_DOUBT * self._parameters.tells_at_most

    @property
    def suspects_elsewhere(self) -> bool:
        """Whether the last search has shown that the robot is clearly likelier elsewhere."""
        return self._suspects

    def open_places(self, episode: Episode) -> list[Found]:
        """The places that explain what is seen and are hardly worse than the best, best first."""
        ranked = _ranked(done(self._weigh(self._open, looks_of(episode, _SCANS_WEIGHED))))
        return [
            each
            for each in ranked
            if each.score > self._parameters.found_above
            and each.score > ranked[0].score - _IN_THE_RUNNING
        ]

    def begin(
        self, episode: Episode, followed: Episode | None, path_m: float, *, drifted: bool = False
    ) -> None:
        """Search from now on for where the newest pose is on the map, by what is seen until now.

        Where the robot is still `followed` is believed sooner than other places, which two searches
        in a row have to find then. `path_m` is how far it has driven since it was lost: the
        farther, the more of the surroundings is in the episode, and the smaller a lead has to be to
        be believed. One that has `drifted` off (nothing speaks for having been carried) is likely
        to be near by.
        """
        self.stop()
        self._work = self._search(_Evidence.of(episode, followed, path_m, drifted))

    def go_on(self, *, to_its_end: bool = False) -> Found | None:
        """Do what fits into one update; at the search's end where the robot is, if that is clear.

        Nothing where no search goes on.
        """
        for _ in count() if to_its_end else range(_PIECES):
            if self._work is None:
                break
            try:
                next(self._work)
            except StopIteration as ended:
                found: Found | None = ended.value
                since = self._since
                self.stop()
                return found and Found(compose(found.pose, since), found.score)
        return None

    def _search(self, seen: "_Evidence") -> Work[Found | None]:
        if not len(self._grid.segments):
            return None
        won, self._won = self._won, None
        places = yield from self._climbers(seen)
        roughly = yield from self._weigh(places, seen.roughly)
        found = yield from self._finalists(seen, _poses_of(_in_the_running(roughly)))
        self._open = compose(_poses_of(_in_the_running(found)), self._since)
        here = None
        if seen.here is not None and seen.followed is not None:
            (here,) = yield from self._weigh(seen.here[None], seen.followed)
        self._suspects = here is None or self._is_likelier(found, here, seen)
        winner = self._clear_winner(found, here, won, seen)
        if winner is None:
            return None
        self._won = compose(winner.pose, self._since)
        if here is not None:
            if same_place(winner.pose, here.pose):
                return winner
            if won is None or not same_place(winner.pose, won):
                return None
        return (yield from self._sharpened(winner, seen))

    def _climbers(self, seen: "_Evidence") -> Work[Floats]:
        """The places of the lattice that look right, each where what is seen fits best."""
        wide = yield from self._lattice.candidates(seen.points, self._everywhere, _CANDIDATES)
        merits = np.zeros(len(wide))
        for piece in self._portions(wide, seen.glance):
            glances(self._grid, seen.glance, wide[piece], merits[piece])
            yield
        places = wide[np.argsort(-merits, kind="stable")[:_CLIMBERS]]
        if seen.here is not None:
            region = Region.around(seen.here, self._parameters.known_within_m)
            near = yield from self._lattice.candidates(seen.points, region, _NEAR)
            places = np.concatenate((places, near))
        yield from self._polish(places, seen.newest, _FIRST_GATES_M)
        return places

    def _finalists(self, seen: "_Evidence", places: Floats) -> Work[list[Found]]:
        """Places new and still open, with what speaks for each."""
        # What was left open has come along with the robot since this search began.
        still_open = compose(self._open, relative(self._since, np.zeros(3)))
        polished = np.concatenate((still_open, places))
        yield from self._polish(polished, seen.few, GATES_M)
        return (yield from self._weigh(self._possible(polished), seen.many))

    def _sharpened(self, found: Found, seen: "_Evidence") -> Work[Found]:
        """The best place around one: along a corridor points slide only so far by themselves."""
        aside = [[ahead_m, left_m, 0.0] for ahead_m, left_m in product(_AROUND_M, _AROUND_M)]
        around = compose(found.pose, np.array(aside))
        yield from self._polish(around, seen.few, _LAST_GATES_M)
        weighed = yield from self._weigh(self._possible(around), seen.many)
        return max([found, *weighed], key=lambda each: each.score)

    def _polish(self, places: Floats, looks: Looks, gates_m: Floats) -> Work[None]:
        for piece in self._portions(places, looks, len(gates_m)):
            polish(self._grid, looks, gates_m, self._cos_max_angle, places[piece])
            yield

    def _possible(self, places: Floats) -> Floats:
        may_be_at = self._may_be_at
        if may_be_at is None:
            return places
        return places[[may_be_at(float(each[0]), float(each[1])) for each in places]]

    def _weigh(self, places: Floats, looks: Looks) -> Work[list[Found]]:
        """Places with what speaks for each."""
        anywhere = self._anywhere.mean_log_likelihood(looks)
        yield
        scores = np.zeros(len(places))
        for piece in self._portions(places, looks):
            log_likelihoods(self._grid, looks, places[piece], self._anywhere.model, scores[piece])
            yield
        scores -= anywhere
        return [Found(*each) for each in zip(places, scores.tolist(), strict=True)]

    def _portions(self, places: Floats, looks: Looks, times: int = 1) -> Iterator[slice]:
        """Pieces of work: for each place all beams of some looks are cast, so many times.

        What is made of a ray takes about as long as to cast it.
        """
        ray_m = _RAY_BEGINS_M + self._anywhere.mean_range_m
        rays = 2 * times * max(len(looks.bearings), 1)
        return pieces(len(places), int(_RAYS_PER_PIECE_M / (rays * ray_m)))

    def _clear_winner(
        self, found: list[Found], here: Found | None, won: Poses | None, seen: "_Evidence"
    ) -> Found | None:
        """The place that is clearly the likeliest, or is it again."""
        its = self._parameters
        if here is not None:
            found = [here, *found]
        merits = [each.score + self._prior(each, seen) for each in found]
        best = int(np.argmax(merits)) if merits else None
        if best is None or merits[best] <= its.found_above:
            return None
        place = found[best].pose
        rivals = [
            merit
            for each, merit in zip(found, merits, strict=True)
            if not same_place(each.pose, place)
        ]
        doubt = max(_LEAST_DOUBT, 1.0 - (1.0 - _LEAST_DOUBT) * seen.path_m / its.blind_for_m)
        if here is not None and same_place(place, here.pose):
            doubt = _LEAST_DOUBT
        # The right place may be among those that were not found.
        lead = merits[best] - max([its.found_above, *rivals])
        again = won is not None and same_place(place, won)
        return found[best] if again or lead >= doubt * its.tells_at_most else None

    def _is_likelier(self, found: list[Found], here: Found, seen: "_Evidence") -> bool:
        """Whether it is clearly likelier that the robot is elsewhere, if not where.

        At one of the places, or anywhere on the map.
        """
        others = [
            each.score + self._prior(each, seen)
            for each in found
            if not same_place(each.pose, here.pose)
        ]
        lead = max([0.0, *others]) - here.score - self._prior(here, seen)
        return lead >= self._least_lead

    def _prior(self, found: Found, seen: "_Evidence") -> float:
        """Log odds of a place: who has drifted off is near by."""
        its, here = self._parameters, seen.here
        if here is None or not seen.drifted:
            return 0.0
        near = np.hypot(*(found.pose - here)[:2]) < its.known_within_m
        return its.found_above if near else 0.0


@dataclass(frozen=True, slots=True)
class _Evidence:
    """What one search goes by: looks at what was seen since, and at the way that is followed."""

    points: Floats
    glance: Looks
    newest: Looks
    roughly: Looks
    few: Looks
    many: Looks
    here: Poses | None
    followed: Looks | None
    path_m: float
    drifted: bool

    @classmethod
    def of(
        cls, episode: Episode, followed: Episode | None, path_m: float, drifted: bool
    ) -> "_Evidence":
        """`followed` where the robot is, by what was seen since the episode began."""
        return cls(
            points=_submap(episode),
            glance=looks_of(episode, 1, _BEAMS_GLANCED),
            newest=looks_of(episode, 1),
            roughly=looks_of(episode, 2),
            few=looks_of(episode, _SCANS_POLISHED),
            many=looks_of(episode, _SCANS_WEIGHED),
            here=None if followed is None else followed.poses[-1].copy(),
            followed=(
                None
                if followed is None
                else looks_of(followed, _SCANS_WEIGHED, newest=len(episode))
            ),
            path_m=path_m,
            drifted=drifted,
        )


def _poses_of(found: list[Found]) -> Floats:
    return np.array([each.pose for each in found]).reshape(-1, 3)


def _ranked(found: list[Found]) -> list[Found]:
    """The best first, and of those at the same place only the best."""
    ranked = sorted(found, key=lambda each: -each.score)
    return [ranked[index] for index in distinct(_poses_of(ranked))]


def _in_the_running(found: list[Found]) -> list[Found]:
    """The distinct places that are not much worse than the best, best first."""
    ranked = _ranked(found)
    if not ranked:
        return ranked
    near = sum(each.score > ranked[0].score - _IN_THE_RUNNING for each in ranked)
    return ranked[: max(_LEAST_FINALISTS, min(near, _MOST_FINALISTS))]


def _submap(episode: Episode) -> Floats:
    """All points of an episode in the frame of its newest pose, one per small cell."""
    newest = episode.poses[-1]
    points = np.concatenate(
        [
            transform(relative(newest, pose), node.scan_points.points)
            for node, pose in zip(episode.nodes, episode.poses, strict=True)
        ]
    )
    cells = np.floor(points / _THINNED_M).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.ascontiguousarray(points[np.sort(first)])

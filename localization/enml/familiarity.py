"""Whether a robot still sees what it saw just before. Whoever does not was carried elsewhere."""

from collections.abc import Callable
from math import cos

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.change import changed
from mend.localization.enml.episode import Episode
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.pose import Poses, relative, transform, turn

LEAST_RETURNS = 40
"""Fewer returns say nothing about where a robot is."""


class Familiarity:
    """Compares the newest scan with those before; one surprise is none yet."""

    def __init__(
        self, behind: Callable[[PoseNode, Floats], float], parameters: EnmlParameters
    ) -> None:
        """`behind`: which share of a scan, taken at a pose, lies behind walls of the map."""
        self._behind = behind
        self._parameters = parameters
        self.forget()

    def forget(self) -> None:
        """Begin anew: nothing was surprising yet."""
        self._familiar: int | None = None
        self._changes = self._strangers = 0

    def notices_change(self, episode: Episode, unexplained: float, *, on_map: bool) -> bool:
        """Whether too much is seen that was not there before, in enough scans in a row.

        `unexplained` is the share of the newest scan that fits neither the map nor the scans
        before; it and what is behind walls count only for who believes to be `on_map`.
        """
        before = self._last_familiar(episode)
        if before is None:
            return False
        nodes, poses, parameters = episode.nodes, episode.poses, self._parameters
        change = changed(nodes[before], poses[before], nodes[-1], poses[-1])
        usual = parameters.carried_above_per_m * _apart(episode, before)
        if on_map:
            change += parameters.carried_unexplained_counts * unexplained
            if change > parameters.carried_maybe_above + usual:
                now, then = (self._behind(nodes[each], poses[each]) for each in (-1, before))
                change += parameters.carried_behind_counts * max(now - then, 0.0)
        if change <= parameters.carried_above + usual:
            self._familiar, self._changes = None, 0
            return False
        self._familiar = nodes[before].identity
        self._changes += 1
        return self._changes >= parameters.carried_after_scans

    def notices_strangers(self, episode: Episode) -> bool:
        """Whether nothing of what is on no map is recognized, however alike the walls.

        For an episode whose newest scan is classified; in enough scans in a row.
        """
        before = self._last_familiar(episode)
        strange = before is not None and self._is_strange(episode, before)
        self._strangers = self._strangers + 1 if strange else 0
        return self._strangers >= self._parameters.carried_after_scans

    def _is_strange(self, episode: Episode, before: int) -> bool:
        parameters, newest = self._parameters, episode.nodes[-1]
        off_map = ~newest.is_ltf
        if (
            off_map.mean() <= parameters.strange_above
            or newest.is_stf[off_map].mean() >= parameters.strange_recognized_below
            or _apart(episode, before) > parameters.strange_within
        ):
            return False
        # What was on the map before, and is off it now, is in no short-term feature.
        recognized = seen_before(
            episode.nodes[before],
            newest,
            relative(episode.poses[before], episode.poses[-1]),
            parameters,
        )
        return bool(recognized[off_map].mean() < parameters.strange_recognized_below)

    def _last_familiar(self, episode: Episode) -> int | None:
        """The last pose before the newest that saw enough, and nothing surprising."""
        *before, newest = episode.nodes
        if len(newest.scan_points) < LEAST_RETURNS:
            return None
        familiar = None
        for index, node in enumerate(before):
            if len(node.scan_points) >= LEAST_RETURNS:
                familiar = index
            if node.identity == self._familiar:
                break
        return familiar


def seen_before(
    earlier: PoseNode, later: PoseNode, motion: Poses, parameters: EnmlParameters
) -> NDArray[np.bool_]:
    """Which points of a scan lie where an earlier one saw some, on a surface that faces alike.

    `motion` leads from the earlier pose to the later. The earlier scan must not be empty.
    """
    points = transform(motion, later.scan_points.points)
    normals = turn(float(motion[2]), later.scan_points.normals)
    away_m, nearest = earlier.tree.query(points)
    alike = np.sum(normals * earlier.scan_points.normals[nearest], axis=1)
    seen: NDArray[np.bool_] = (away_m < parameters.stf_gate_m) & (
        alike > cos(parameters.stf_max_angle_rad)
    )
    return seen


def _apart(episode: Episode, before: int) -> float:
    """Metres moved and radians turned between a pose and the newest."""
    x, y, turned = relative(episode.poses[before], episode.poses[-1])
    return float(np.hypot(x, y) + abs(turned))

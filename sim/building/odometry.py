"""What a robot's wheels say about its way: never quite what it was."""

import math
from dataclasses import dataclass

import numpy as np

from mend.documents.strict_model import StrictModel


@dataclass(frozen=True, slots=True)
class OdometryNoise:
    """Standard deviations of the errors, after Thrun, Burgard, Fox, Probabilistic Robotics, 5.4.

    Random ones grow with the root of what was driven, so that it does not matter in how small
    steps it is read. The scales and the pull are drawn once: they are one robot's for good.
    """

    along_m: float = 0.02
    """Of each metre's length, for every metre (random)."""
    across_m: float = 0.01
    """Sideways, for every metre (random)."""
    turn_by_way_rad: float = 0.01
    """Of the heading, for every metre (random)."""
    turn_by_turn_rad: float = 0.03
    """Of the heading, for every radian turned (random)."""
    scale: float = 0.01
    """Of what a metre is for the robot (drawn once): a wheel that is worn."""
    turn_scale: float = 0.02
    """Of what a radian is (drawn once): the track's width."""
    pull_rad_per_m: float = 0.005
    """Of how far it turns unawares on each metre (drawn once): wheels that differ."""
    slips_per_m: float = 0.02
    """How often its wheels begin to slip..."""
    slip_m: float = 0.3
    """... for so far..."""
    slip_share: float = 0.5
    """... and turn in vain for up to this share of what they measure."""


NOISE = OdometryNoise()


class OdometerSnapshot(StrictModel):
    """What an odometer goes on from."""

    pose: tuple[float, float, float]
    scale: float
    turn_scale: float
    pull_rad_per_m: float
    slip_left_m: float
    slip_share: float


class Odometer:
    """Adds up what the wheels measure; `pose` is where that leads, from (0, 0, 0)."""

    def __init__(self, rng: np.random.Generator, noise: OdometryNoise = NOISE) -> None:
        self._rng = rng
        self._noise = noise
        scale, turn_scale, pull = rng.standard_normal(3)
        self._scale = 1.0 + noise.scale * float(scale)
        self._turn_scale = 1.0 + noise.turn_scale * float(turn_scale)
        self._pull_rad_per_m = noise.pull_rad_per_m * float(pull)
        self._slip_left_m = self._slip_share = 0.0
        self.pose = (0.0, 0.0, 0.0)

    def drive(self, forward_m: float, left_m: float, turned_rad: float) -> None:
        """The robot really moved so, straight in the heading that it had halfway."""
        way_m = math.hypot(forward_m, left_m)
        if way_m == 0.0 and turned_rad == 0.0:
            return
        noise = self._noise
        along, across, heading = self._rng.standard_normal(3).tolist()
        root = math.sqrt(way_m)
        measured = self._scale * self._slipping(way_m) * way_m + noise.along_m * root * along
        beside = noise.across_m * root * across
        direction = math.atan2(left_m, forward_m)
        turned = self._turn_scale * turned_rad + self._pull_rad_per_m * way_m
        turned += heading * math.sqrt(
            noise.turn_by_way_rad**2 * way_m + noise.turn_by_turn_rad**2 * abs(turned_rad)
        )
        x, y, yaw = self.pose
        towards = yaw + turned / 2.0 + direction
        self.pose = (
            x + measured * math.cos(towards) - beside * math.sin(towards),
            y + measured * math.sin(towards) + beside * math.cos(towards),
            math.remainder(yaw + turned, math.tau),
        )

    def _slipping(self, way_m: float) -> float:
        """How many metres the wheels turn for one that the robot gets on."""
        begins, share = self._rng.random(2).tolist()
        if self._slip_left_m > 0.0:
            self._slip_left_m -= way_m
        elif begins < self._noise.slips_per_m * way_m:
            self._slip_left_m = self._noise.slip_m
            self._slip_share = self._noise.slip_share * share
        return 1.0 / (1.0 - self._slip_share) if self._slip_left_m > 0.0 else 1.0

    def snapshot(self) -> OdometerSnapshot:
        """What `restore` goes on from; draws come from the world's generator."""
        return OdometerSnapshot(
            pose=self.pose,
            scale=self._scale,
            turn_scale=self._turn_scale,
            pull_rad_per_m=self._pull_rad_per_m,
            slip_left_m=self._slip_left_m,
            slip_share=self._slip_share,
        )

    def restore(self, kept: OdometerSnapshot) -> None:
        """Go on from there."""
        self.pose = kept.pose
        self._scale, self._turn_scale = kept.scale, kept.turn_scale
        self._pull_rad_per_m = kept.pull_rad_per_m
        self._slip_left_m, self._slip_share = kept.slip_left_m, kept.slip_share

"""How wrong odometry may be, and particles moved by it."""

from dataclasses import dataclass
from math import radians

import numpy as np

from mend.localization.pose import Poses, compose


@dataclass(frozen=True, slots=True)
class MotionNoise:
    """Standard deviations of a motion; the default fits wheels on indoor floors.

    Errors of wheels add up like a random walk, so they grow with the root of the way; a turn's
    error grows with the turn. The floors keep particles apart where the robot hardly moves.
    """

    place_m_per_sqrt_m: float = 0.07
    turn_rad_per_sqrt_m: float = 0.05
    turn_share: float = 0.12
    """Radians of error per radian turned."""
    place_floor_m: float = 0.005
    turn_floor_rad: float = radians(0.3)

    def deviations(self, odometry: Poses) -> Poses:
        """Standard deviations (x, y, theta) of one motion, in the robot's frame."""
        root_m = float(np.sqrt(np.hypot(odometry[0], odometry[1])))
        place_m = self.place_floor_m + self.place_m_per_sqrt_m * root_m
        turn = self.turn_floor_rad + np.hypot(
            self.turn_rad_per_sqrt_m * root_m, self.turn_share * abs(float(odometry[2]))
        )
        return np.array([place_m, place_m, turn])


def moved(
    particles: Poses, odometry: Poses, noise: MotionNoise, generator: np.random.Generator
) -> Poses:
    """Each particle after the motion with an error of its own."""
    drawn = generator.normal(0.0, 1.0, particles.shape) * noise.deviations(odometry)
    return compose(particles, odometry + drawn)


def scattered(pose: Poses, deviations: Poses, count: int, generator: np.random.Generator) -> Poses:
    """Particles around a pose; standard deviations in metres and radians of the map's frame."""
    particles: Poses = pose + generator.normal(0.0, 1.0, (count, 3)) * deviations
    return particles

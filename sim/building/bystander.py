"""Somebody who stands in the way of robots in a building."""

from dataclasses import dataclass

from mend.sim.building.floor_pose import FloorPose

RADIUS_M = 0.25


@dataclass(frozen=True, slots=True)
class Bystander:
    """Stands there until asked to make way."""

    at: FloorPose

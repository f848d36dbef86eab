"""An object is at its place only if it lies there itself, not on top of another one."""

import pytest

from robots.link.messages import Sighting
from server.runtime.at_place import is_at_place
from tasks.scene import Place, Pose, Scene, Table

LOW, HIGH = Place(pose=Pose(x=0.5, y=0.1)), Place(pose=Pose(x=0.5, y=0.1, z=0.78))
SCENE = Scene(
    name="two_heights", table=Table(height=0.7), objects={}, places={"low": LOW, "high": HIGH}
)


@pytest.mark.parametrize(
    ("place", "x", "z", "is_there"),
    [
        (LOW, 0.51, 0.705, True),
        (LOW, 0.55, 0.70, False),
        (LOW, 0.50, 0.75, False),
        (HIGH, 0.50, 0.775, True),
        (HIGH, 0.50, 0.70, False),
    ],
)
def test_place_and_height_decide(place: Place, x: float, z: float, is_there: bool) -> None:
    seen = Sighting(x=x, y=0.1, z=z, yaw=0.0, time=1.0)
    assert is_at_place(seen, place, SCENE, within_m=0.03) is is_there

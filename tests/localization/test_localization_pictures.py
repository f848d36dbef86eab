"""Pictures and films of a drive."""

from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest
from made_up_floor import FLOOR

from mend.localization.localizer import Estimate, PointClass
from mend.localization.pictures.colors import MAP, POINTS
from mend.localization.pictures.drive import Drive, save_map_picture
from mend.localization.points import scan_points
from mend.localization.scan import Scan


def _drive() -> Drive:
    """Five metres along the corridor, with a point of each class at every step."""
    scan = Scan(np.full(3, 0.7), -1.0, 1.0, 8.0)
    points = scan_points(scan)
    classes = np.array([PointClass.LTF, PointClass.STF, PointClass.DF], dtype=np.int8)
    drive = Drive(FLOOR, "corridor", np.full((11, 3), np.nan))
    for number in range(11):
        pose = np.array([2.0 + 0.5 * number, 7.0, 0.0])
        drive.take(Estimate(pose, np.eye(3) * 0.01, points, classes, 0.0, False))
    return drive


def _has(image: np.ndarray, color: tuple[int, int, int]) -> bool:
    """Smooth edges mix a thin line's color with the paper's, so it need only be near."""
    off = np.abs(image[..., ::-1].astype(int) - color).max(axis=2)
    return bool((off < 60).any())


def test_a_picture_has_the_map_and_every_class_in_its_color(tmp_path: Path) -> None:
    path = tmp_path / "drive.png"
    _drive().save_picture(path)
    image = cv2.imread(str(path))
    assert _has(image, MAP)
    assert all(_has(image, color) for color in POINTS.values())


def test_an_svg_has_a_shape_per_class(tmp_path: Path) -> None:
    path = tmp_path / "drive.svg"
    _drive().save_picture(path)
    strokes = {each.get("stroke") for each in ElementTree.parse(path).iter()}
    assert {f"rgb{color}" for color in (MAP, *POINTS.values())} <= strokes


@pytest.mark.parametrize("name", ["drive.mp4", "drive.gif"])
def test_a_film_has_a_frame_per_moment(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    drive = _drive()
    drive.save_animation(path)
    film = cv2.VideoCapture(str(path))
    frames = 0
    while film.read()[0]:
        frames += 1
    assert frames == len(drive.moments) == 11


def test_a_map_is_drawn(tmp_path: Path) -> None:
    save_map_picture(FLOOR, tmp_path / "map.png")
    save_map_picture(FLOOR, tmp_path / "map.svg")
    assert _has(cv2.imread(str(tmp_path / "map.png")), MAP)
    assert "floor: 20 segments" in (tmp_path / "map.svg").read_text()

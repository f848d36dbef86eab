"""The benchmark's MRPT peer, with its programs played."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from peers import mrpt

from mend.localization.logs.log import Log, LogStep
from mend.localization.scan import Scan
from mend.maps.vector_map import VectorMap

WALLS = VectorMap(np.array([[1.0, 2.0, 5.0, 2.0], [5.0, 2.0, 5.0, 4.0]]))


def half_circle(number: int, beams: int = 180) -> LogStep:
    motion = np.array([0.5, 0.0, 0.0]) if number else np.zeros(3)
    scan = Scan(np.full(beams, 3.0), -np.pi / 2, np.pi / 180, 8.0, number / 10)
    return LogStep(motion, scan, np.array([2.0 + 0.5 * number, 3.0, 0.0]))


class PlayedMrpt:
    """Keeps what the programs would have been given, and says what the last one would."""

    def __init__(self, said: str) -> None:
        self.said = said
        self.commands: list[tuple[str, ...]] = []
        self.files: dict[str, str] = {}
        self.picture = np.zeros((0, 0), np.uint8)

    def __call__(self, folder: Path, *command: str) -> str:
        self.commands.append(command)
        self.files |= {each.name: each.read_text() for each in folder.glob("drive.*")}
        drawn = cv2.imread(str(folder / "map.png"), cv2.IMREAD_GRAYSCALE)
        self.picture = np.asarray(drawn, np.uint8)
        return self.said if command[0] == "pf-localization" else ""


def estimates(count: int) -> str:
    return "".join(
        f"[x] Done in {number + 2}.5ms, ESS=0.5\n"
        f"[x] PDF estimation: ({2 + 0.5 * number:.3f},3.100,90.00deg), ESS (B.R.)= 0.3\n"
        for number in range(count)
    )


def test_poses_and_durations_are_read_from_what_it_prints() -> None:
    log = Log("hall", tuple(half_circle(number) for number in range(3)))
    trace = mrpt.mrpt_trace(WALLS, log, PlayedMrpt(estimates(3)))
    assert trace.errors_m == pytest.approx([0.1, 0.1, 0.1])
    assert trace.poses[:, 2] == pytest.approx(np.full(3, np.pi / 2))
    assert trace.durations_s == pytest.approx([0.0025, 0.0035, 0.0045])


def test_it_is_given_odometry_and_never_the_reference() -> None:
    log = Log("hall", tuple(half_circle(number) for number in range(3)))
    played = PlayedMrpt(estimates(3))
    mrpt.mrpt_trace(WALLS, log, played)
    lines = played.files["drive.log"].splitlines()
    assert [line.split()[1:3] for line in lines if line.startswith("ODOM")] == [
        ["0.000000", "0.000000"],
        ["0.500000", "0.000000"],
        ["1.000000", "0.000000"],
    ]
    assert "init_PDF_min_x=1.8000" in played.files["drive.ini"]


def test_the_map_is_drawn_where_its_origin_is_said_to_be() -> None:
    log = Log("hall", (half_circle(0),))
    played = PlayedMrpt(estimates(1))
    mrpt.mrpt_trace(WALLS, log, played)
    drawing = next(each for each in played.commands if each[0] == "image2gridmap")
    column = int(drawing[drawing.index("--px") + 1]) + round(5.0 / mrpt.CELL_M)
    row = int(drawing[drawing.index("--py") + 1]) + round(3.0 / mrpt.CELL_M)
    assert played.picture[::-1][row, column] == 0
    assert played.picture[::-1][row, column + 5] == 255


@pytest.mark.parametrize(("beams", "said"), [(180, "told 2 poses of 3"), (90, "half circles")])
def test_what_it_cannot_follow_is_said(beams: int, said: str) -> None:
    log = Log("hall", tuple(half_circle(number, beams) for number in range(3)))
    with pytest.raises(mrpt.MrptError, match=said):
        mrpt.mrpt_trace(WALLS, log, PlayedMrpt(estimates(2)))

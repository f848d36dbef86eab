"""What `mend localize` and `mend map` share: the files that they read, and how long it takes."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from mend.server.cli.failures import CommandLineError

if TYPE_CHECKING:
    from rich.console import Console

    from mend.localization.logs.log import RecordedDrive
    from mend.localization.pose import Poses
    from mend.maps.vector_map import VectorMap

LOG_HELP = "A ROS bag (.bag, .db3, .mcap or a folder), or a CARMEN, Wean Hall or CSV log."
MAP_HELP = "A vector map (.txt or .json), or a Nav2 map.yaml, whose lines are extracted."


def checked_suffix(what: str, path: Path | None, suffixes: tuple[str, ...]) -> None:
    """Raises `CommandLineError` where a file that is to be written has no such end."""
    if path is not None and path.suffix not in suffixes:
        ends = " or ".join(suffixes)
        raise CommandLineError(f"the {what}'s file has to end in {ends}, which '{path}' does not")


def check_choice(log: Path, *chosen: str | None) -> None:
    """Raises `CommandLineError` where something is chosen of a log that is no bag."""
    from mend.localization.bags.bag import is_bag

    if any(each is not None for each in chosen) and not is_bag(log):
        raise CommandLineError(
            f"{log}: only a ROS bag has topics and frames to choose, and poses to judge; this is "
            "none (.bag, .db3, .mcap, or a folder)"
        )


def given_pose(option: str, text: str | None) -> "Poses | None":
    """The pose x,y,theta that an option gives. Raises `CommandLineError`."""
    import numpy as np

    if text is None:
        return None
    try:
        values = [float(each) for each in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not all(isfinite(each) for each in values):
        raise CommandLineError(
            f"{option} needs three numbers x,y,theta (metres, radians), which '{text}' is not"
        )
    return np.array(values)


def read_floor(map_file: Path, picture: Path | None, console: "Console") -> "VectorMap":
    """The map of a file; `picture` is drawn to judge extracted lines by. Raises as `read_map`."""
    from mend.localization.pictures.drive import save_map_picture
    from mend.localization.pictures.occupancy import save_extraction
    from mend.maps.reading import read_map

    floor = read_map(map_file)
    if picture is not None:
        picture.parent.mkdir(parents=True, exist_ok=True)
        if floor.picture is None:
            save_map_picture(floor.lines, picture)
        else:
            save_extraction(floor.picture, floor.lines, picture)
    elif floor.picture is not None:
        console.print(
            f"{map_file}: {len(floor.lines)} lines extracted; --plot-map draws them over the cells"
        )
    if not len(floor.lines):
        console.print(f"mend: {map_file}: the map is empty, so nothing will be recognised")
    return floor.lines


def told_drive(drive: "RecordedDrive", console: "Console") -> None:
    """Say what was chosen of a bag, and what could not be used."""
    from mend.localization.bags.reading import BagDrive

    if isinstance(drive, BagDrive):
        console.print(drive.told)
        if drive.skipped:
            console.print(
                f"{drive.bag.path}: {drive.skipped} of {len(drive.used)} scans are left out: no "
                "odometry at their time, or not as many beams as most"
            )


def get_ready(console: "Console", method: str) -> None:
    """Say what takes so long: on a machine's first use the method's kernels are compiled."""
    from mend.localization.methods import warm_up

    words = f"getting {method} ready (compiled on first use, about a minute; then kept)"
    if console.is_terminal:
        with console.status(words):
            warm_up(method)
    else:
        console.print(words)
        warm_up(method)


@contextmanager
def progress(console: "Console", scans: int) -> Iterator[Callable[[], None]]:
    """A bar in a terminal, nothing elsewhere; what is yielded moves it by one scan."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = ("scans", BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as bar:
        task = bar.add_task("scans", total=scans)
        yield lambda: bar.advance(task)

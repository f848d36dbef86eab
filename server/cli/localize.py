"""`mend localize`: follow a robot through a recorded drive."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.failures import INTERRUPTED, CommandLineError, told_plainly
from mend.server.cli.rows import print_rows

if TYPE_CHECKING:
    from rich.console import Console

    from mend.localization.evaluation import Summary
    from mend.localization.pose import Poses

HEADINGS = ("figure", "value")


def localize(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="A CARMEN, Wean Hall or CSV log.")],
    map_file: Annotated[
        Path, typer.Option("--map", metavar="MAP", help="A vector map (.txt or .json).")
    ],
    method: Annotated[str, typer.Option(help="enml, cgr or mcl.")] = "enml",
    seed: Annotated[int, typer.Option(min=0, help="The same seed draws the same.")] = 1,
    start: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,THETA",
            help="Where the drive starts (metres, radians); else at the log's first reference.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the drive, as .png or .svg.")] = None,
    animate: Annotated[Path | None, typer.Option(help="Film the drive, as .mp4 or .gif.")] = None,
) -> None:
    """Follow a robot through a recorded drive on a vector map.

    The error is against the log's reference poses, where it has them. Lost is more than 1 m or 30
    degrees off.
    """
    # Imported only here: compiled code would make every other command wait.
    from rich.console import Console

    from mend.localization.evaluation import follow, summarize
    from mend.localization.localizer import Estimate, Timed
    from mend.localization.logs.reading import read_log
    from mend.localization.methods import METHODS
    from mend.localization.pictures.drive import ANIMATION_SUFFIXES, PICTURE_SUFFIXES, Drive
    from mend.maps.vector_map_file import read_vector_map

    if method not in METHODS:
        names = ", ".join(METHODS)
        raise CommandLineError(f"there is no method '{method}'; there are {names}")
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    checked_suffix("animation", animate, ANIMATION_SUFFIXES)
    given = _pose(start) if start is not None else None
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    with told_plainly():
        vector_map = read_vector_map(map_file)
        read = read_log(log)
        first = given if given is not None else read.start
        if first is None:
            raise CommandLineError(
                f"{log}: it has no reference poses, so the start has to be given: --start x,y,theta"
            )
        if not len(vector_map):
            console.print(f"mend: {map_file}: the map is empty, so nothing will be recognised")
        _get_ready(console, method)
        localizer = Timed(METHODS[method](vector_map, seed), time.perf_counter)
        localizer.reset(first)
        drive = Drive(vector_map, f"{read.name}: {method}", read.references)
        drawn = plot is not None or animate is not None
        try:
            with progress(console, len(read)) as advance:

                def take(_: int, estimate: Estimate) -> None:
                    if drawn:
                        drive.take(estimate)
                    advance()

                trace = follow(localizer, read, on_estimate=take)
        except KeyboardInterrupt as error:
            raise CommandLineError("stopped before the log was over", INTERRUPTED) from error
        summary = summarize(trace, read)
        if plot is not None:
            plot.parent.mkdir(parents=True, exist_ok=True)
            drive.save_picture(plot)
        if animate is not None:
            animate.parent.mkdir(parents=True, exist_ok=True)
            drive.save_animation(animate)
    if as_json:
        typer.echo(json.dumps(asdict(summary)))
    else:
        print_rows(_rows(summary), HEADINGS)


def checked_suffix(what: str, path: Path | None, suffixes: tuple[str, ...]) -> None:
    """Raises `CommandLineError` where a file that is to be written has no such end."""
    if path is not None and path.suffix not in suffixes:
        ends = " or ".join(suffixes)
        raise CommandLineError(f"the {what}'s file has to end in {ends}, which '{path}' does not")


def _pose(text: str) -> "Poses":
    import numpy as np

    try:
        values = [float(each) for each in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not all(isfinite(each) for each in values):
        raise CommandLineError(
            f"--start needs three numbers x,y,theta (metres, radians), which '{text}' is not"
        )
    return np.array(values)


def _get_ready(console: "Console", method: str) -> None:
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


def _rows(summary: "Summary") -> list[tuple[str, ...]]:
    """The summary for a person."""

    def words(value: float | None, form: str) -> str:
        return "unknown" if value is None else form.format(value)

    lost = summary.lost_events
    first = "" if summary.first_lost_m is None else f", first after {summary.first_lost_m:.1f} m"
    return [
        ("scans", str(summary.scans)),
        ("path", f"{summary.path_m:.1f} m"),
        ("median error", words(summary.median_error_m, "{:.3f} m")),
        ("median error, heading", words(summary.median_error_deg, "{:.2f} degrees")),
        ("95 % of the errors below", words(summary.p95_error_m, "{:.3f} m")),
        ("largest error", words(summary.max_error_m, "{:.3f} m")),
        ("lost", "unknown" if lost is None else f"{lost} times{first}"),
        ("median update", f"{summary.ms_per_update_p50:.1f} ms"),
        ("95 % of the updates within", f"{summary.ms_per_update_p95:.1f} ms"),
    ]

"""`mend localize`: follow a robot through a recorded drive."""

import json
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.drive_input import (
    LOG_HELP,
    MAP_HELP,
    check_choice,
    checked_suffix,
    get_ready,
    given_pose,
    progress,
    read_floor,
    told_drive,
)
from mend.server.cli.failures import INTERRUPTED, CommandLineError, told_plainly
from mend.server.cli.rows import print_rows

if TYPE_CHECKING:
    from rich.console import Console

    from mend.localization.evaluation import Summary
    from mend.localization.localizer import Estimate
    from mend.localization.logs.log import RecordedDrive
    from mend.localization.pose import Poses
    from mend.maps.vector_map import VectorMap

HEADINGS = ("figure", "value")


def localize(
    log: Annotated[Path, typer.Argument(metavar="LOG", help=LOG_HELP)],
    map_file: Annotated[Path, typer.Option("--map", metavar="MAP", help=MAP_HELP)],
    method: Annotated[str, typer.Option(help="enml, cgr or mcl.")] = "enml",
    seed: Annotated[int, typer.Option(min=0, help="The same seed draws the same.")] = 1,
    start: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,THETA",
            help="Where the drive starts (metres, radians); else at the log's first reference.",
        ),
    ] = None,
    judged: Annotated[
        str | None,
        typer.Option(
            "--judge",
            metavar="TOPIC",
            help="Tell where and since when the localizer of this topic of a bag (or tf) was lost.",
        ),
    ] = None,
    reference: Annotated[
        str | None,
        typer.Option(metavar="TOPIC", help="A bag's poses (or tf) to compare with and start at."),
    ] = None,
    scan: Annotated[
        str | None, typer.Option(metavar="TOPIC", help="The laser, where a bag has several.")
    ] = None,
    odometry: Annotated[
        str | None,
        typer.Option(metavar="TOPIC", help="The odometry, where a bag has several; or tf."),
    ] = None,
    base_frame: Annotated[str | None, typer.Option(help="The robot's frame in a bag.")] = None,
    odom_frame: Annotated[str, typer.Option(help="The odometry's frame in a bag.")] = "odom",
    map_frame: Annotated[str, typer.Option(help="The map's frame in a bag.")] = "map",
    laser_pose: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,THETA",
            help="Where the laser is on the robot (metres, radians); else as a bag's tf says.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the drive, as .png or .svg.")] = None,
    plot_map: Annotated[
        Path | None,
        typer.Option(help="Draw the map, extracted lines over its cells, as .png or .svg."),
    ] = None,
    animate: Annotated[Path | None, typer.Option(help="Film the drive, as .mp4 or .gif.")] = None,
    report: Annotated[
        Path | None, typer.Option(help="With --judge: write a report, as .html.")
    ] = None,
) -> None:
    """Follow a robot through a recorded drive on a map, or judge the localizer that it had.

    The error is against the log's reference poses, where it has them. Lost is more than 1 m or 30
    degrees off.
    """
    # Imported only here: compiled code would make every other command wait.
    from rich.console import Console

    from mend.localization.bags.choice import BagChoice
    from mend.localization.logs.reading import read_drive
    from mend.localization.methods import METHODS
    from mend.localization.pictures.drive import ANIMATION_SUFFIXES, PICTURE_SUFFIXES
    from mend.server.cli.judged_drive import REPORT_SUFFIXES, judge

    if method not in METHODS:
        names = ", ".join(METHODS)
        raise CommandLineError(f"there is no method '{method}'; there are {names}")
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    checked_suffix("map's picture", plot_map, PICTURE_SUFFIXES)
    checked_suffix("animation", animate, ANIMATION_SUFFIXES)
    checked_suffix("report", report, REPORT_SUFFIXES)
    _check_together(judged, reference, animate, report)
    choice = BagChoice(
        scan=scan,
        odometry=odometry,
        poses=judged or reference,
        base_frame=base_frame,
        odom_frame=odom_frame,
        map_frame=map_frame,
        laser_pose=given_pose("--laser-pose", laser_pose),
    )
    check_choice(log, judged, reference, scan, odometry, base_frame, laser_pose)
    given = given_pose("--start", start)
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    with told_plainly():
        vector_map = read_floor(map_file, plot_map, console)
        drive = read_drive(log, choice)
        told_drive(drive, console)
        if judged is not None:
            get_ready(console, method)
            judge(console, drive, judged, vector_map, method, seed, given, as_json, plot, report)
            return
        first = given if given is not None else drive.start
        if first is None:
            raise CommandLineError(_no_start(log))
        get_ready(console, method)
        summary = _follow(console, drive, vector_map, method, seed, first, plot, animate)
    if as_json:
        typer.echo(json.dumps(asdict(summary)))
    else:
        print_rows(_rows(summary), HEADINGS)


def _follow(
    console: "Console",
    read: "RecordedDrive",
    vector_map: "VectorMap",
    method: str,
    seed: int,
    first: "Poses",
    plot: Path | None,
    animate: Path | None,
) -> "Summary":
    """Run the method on the drive, and draw it. Raises `CommandLineError` on Ctrl-C."""
    from mend.localization.evaluation import follow, summarize
    from mend.localization.localizer import Timed
    from mend.localization.methods import METHODS
    from mend.localization.pictures.drive import Drive

    localizer = Timed(METHODS[method](vector_map, seed), time.perf_counter)
    localizer.reset(first)
    drive = Drive(vector_map, f"{read.name}: {method}", read.references)
    drawn = plot is not None or animate is not None
    try:
        with progress(console, len(read)) as advance:

            def take(_: int, estimate: "Estimate") -> None:
                if drawn:
                    drive.take(estimate)
                advance()

            trace = follow(localizer, read, on_estimate=take)
    except KeyboardInterrupt as error:
        raise CommandLineError("stopped before the log was over", INTERRUPTED) from error
    if plot is not None:
        plot.parent.mkdir(parents=True, exist_ok=True)
        drive.save_picture(plot)
    if animate is not None:
        animate.parent.mkdir(parents=True, exist_ok=True)
        drive.save_animation(animate)
    return summarize(trace, read)


def _check_together(
    judged: str | None, reference: str | None, animate: Path | None, report: Path | None
) -> None:
    """Raises `CommandLineError` for options of which one makes no sense beside the other."""
    if judged is not None and reference is not None:
        raise CommandLineError("--judge already names the poses: --reference cannot stand with it")
    if judged is not None and animate is not None:
        raise CommandLineError("--judge draws a picture (--plot, --report), but no animation")
    if judged is None and report is not None:
        raise CommandLineError("--report is about what --judge finds: say what is to be judged")


def _no_start(log: Path) -> str:
    from mend.localization.bags.bag import is_bag
    from mend.localization.bags.reading import other_poses

    told = f"{log}: it has no reference poses, so the start has to be given: --start x,y,theta"
    if is_bag(log):
        there = other_poses(log)
        told = (
            f"{log}: where the drive starts has to be given: --start x,y,theta, or --reference "
            f"with a topic that tells it (or tf); in the bag: {there or 'none'}"
        )
    return told


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

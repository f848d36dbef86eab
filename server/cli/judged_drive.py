"""`mend localize --judge`: our localizer beside the poses of another."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mend.server.cli.drive_input import progress
from mend.server.cli.failures import INTERRUPTED, CommandLineError

if TYPE_CHECKING:
    from rich.console import Console

    from mend.localization.localizer import Estimate
    from mend.localization.logs.log import RecordedDrive
    from mend.localization.pose import Poses
    from mend.maps.vector_map import VectorMap

REPORT_SUFFIXES = (".html",)


def judge(
    console: "Console",
    drive: "RecordedDrive",
    topic: str,
    vector_map: "VectorMap",
    method: str,
    seed: int,
    start: "Poses | None",
    as_json: bool,
    plot: Path | None,
    report: Path | None,
) -> None:
    """Judge a drive's reference poses, and say where they were lost.

    Raises `WrongInputError`, `UnavailableError`, `OSError`, or `CommandLineError` on Ctrl-C.
    """
    from mend.localization.judging.drive import judge_drive
    from mend.localization.methods import METHODS
    from mend.localization.pictures.judged import judged_svg, save_judged
    from mend.server.report.judged_page import (
        JudgedDrive,
        as_plain,
        sentences,
        verdict_of,
        write_judged_report,
    )

    try:
        with progress(console, len(drive)) as advance:

            def take(_: int, __: "Estimate") -> None:
                advance()

            judgement = judge_drive(
                drive,
                drive.references,
                vector_map,
                lambda: METHODS[method](vector_map, seed),
                start,
                take,
            )
    except KeyboardInterrupt as error:
        raise CommandLineError("stopped before the drive was over", INTERRUPTED) from error
    title = f"{drive.name}: {topic} judged by {method}"
    if plot is not None:
        plot.parent.mkdir(parents=True, exist_ok=True)
        save_judged(judgement, vector_map, title, plot)
    judged = JudgedDrive(
        judgement,
        drive.name,
        topic,
        method,
        vector_map.name,
        judged_svg(judgement, vector_map, title) if report is not None else "",
    )
    if report is not None:
        write_judged_report(report, judged)
    if as_json:
        typer.echo(json.dumps(as_plain(judged)))
        return
    typer.echo(f"{topic}: {verdict_of(judgement)}")
    for each in sentences(judgement):
        typer.echo(f"- {each}")
    if judgement.ours_corrected:
        typer.echo(
            f"- {len(judgement.ours_corrected)} times the scans spoke for {topic} against our own "
            "track, which was then set to it"
        )

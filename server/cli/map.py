"""`mend map`: build vector maps from recorded drives, extract them from pictures, clean them up."""

from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.drive_input import (
    LOG_HELP,
    check_choice,
    checked_suffix,
    progress,
    read_floor,
    told_drive,
)
from mend.server.cli.failures import CommandLineError, told_plainly

app = typer.Typer(
    name="map",
    help="Build, extract and clean up vector maps.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

OutputFile = Annotated[
    Path, typer.Option("--output", "-o", metavar="MAP", help="Where to write it, .txt or .json.")
]
PlotFile = Annotated[Path | None, typer.Option(help="Draw the map, as .png or .svg.")]


@app.command("build", short_help="Build a vector map from a recorded drive.")
def build(
    log: Annotated[Path, typer.Argument(metavar="LOG", help=LOG_HELP)],
    output: OutputFile,
    plot: PlotFile = None,
    reference: Annotated[
        str | None,
        typer.Option(metavar="TOPIC", help="A bag's poses (or tf) to take for references."),
    ] = None,
    scan: Annotated[
        str | None, typer.Option(metavar="TOPIC", help="The laser, where a bag has several.")
    ] = None,
    odometry: Annotated[
        str | None,
        typer.Option(metavar="TOPIC", help="The odometry, where a bag has several; or tf."),
    ] = None,
) -> None:
    """Build a vector map from a recorded drive.

    The drive's reference poses say where the walls are. A log that has none is matched scan to
    scan: good enough for a floor or two, but loops do not close by themselves.
    """
    import numpy as np
    from rich.console import Console

    from mend.localization.bags.choice import BagChoice
    from mend.localization.logs.reading import read_drive
    from mend.localization.mapping import map_of
    from mend.localization.pictures.drive import PICTURE_SUFFIXES, save_map_picture
    from mend.localization.scan_matching import matched_poses
    from mend.maps.vector_map_file import write_vector_map

    checked_suffix("map", output, (".txt", ".json"))
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    check_choice(log, reference, scan, odometry)
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    with told_plainly():
        read = read_drive(log, BagChoice(scan=scan, odometry=odometry, poses=reference))
        told_drive(read, console)
        poses = read.references
        if not np.isfinite(poses).all():
            console.print(f"{log}: not every scan has a reference pose; matching scan to scan")
            with progress(console, len(read)) as advance:
                poses = matched_poses(read, advance)
        vector_map = map_of(read, poses)
        if not len(vector_map):
            raise CommandLineError(f"{log}: no wall is to be seen in it")
        output.parent.mkdir(parents=True, exist_ok=True)
        write_vector_map(vector_map, output)
        if plot is not None:
            plot.parent.mkdir(parents=True, exist_ok=True)
            save_map_picture(vector_map, plot)
    typer.echo(f"{output}: {len(vector_map)} segments, {vector_map.lengths.sum():.1f} m of walls")


@app.command("lines", short_help="Extract the lines of a Nav2 map.")
def lines(
    map_file: Annotated[Path, typer.Argument(metavar="MAP", help="A Nav2 map.yaml.")],
    output: OutputFile,
    plot: PlotFile = None,
) -> None:
    """Extract the walls of an occupancy map as lines; the picture shows them over its cells."""
    from rich.console import Console

    from mend.localization.pictures.drive import PICTURE_SUFFIXES
    from mend.maps.vector_map_file import write_vector_map

    checked_suffix("map", output, (".txt", ".json"))
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    with told_plainly():
        extracted = read_floor(map_file, plot, console)
        output.parent.mkdir(parents=True, exist_ok=True)
        write_vector_map(extracted, output)
    typer.echo(f"{output}: {len(extracted)} segments, {extracted.lengths.sum():.1f} m of walls")


@app.command("clean", short_help="Clean a vector map up.")
def clean(
    map_file: Annotated[Path, typer.Argument(metavar="MAP", help="A vector map.")],
    output: OutputFile,
    plot: PlotFile = None,
) -> None:
    """Make duplicates and overlaps one segment each, and drop slivers."""
    from mend.localization.pictures.drive import PICTURE_SUFFIXES, save_map_picture
    from mend.maps.clean_up import clean_up
    from mend.maps.vector_map_file import read_vector_map, write_vector_map

    checked_suffix("map", output, (".txt", ".json"))
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    with told_plainly():
        before = read_vector_map(map_file)
        after = clean_up(before)
        output.parent.mkdir(parents=True, exist_ok=True)
        write_vector_map(after, output)
        if plot is not None:
            plot.parent.mkdir(parents=True, exist_ok=True)
            save_map_picture(after, plot)
    typer.echo(f"{output}: {len(after)} segments of {len(before)}")

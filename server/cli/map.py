"""`mend map`: build vector maps from recorded drives, and clean them up."""

from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.failures import CommandLineError, told_plainly
from mend.server.cli.localize import checked_suffix, progress

app = typer.Typer(
    name="map", help="Build and clean up vector maps.", no_args_is_help=True, rich_markup_mode=None
)

OutputFile = Annotated[
    Path, typer.Option("--output", "-o", metavar="MAP", help="Where to write it, .txt or .json.")
]
PlotFile = Annotated[Path | None, typer.Option(help="Draw the map, as .png or .svg.")]


@app.command("build", short_help="Build a vector map from a recorded drive.")
def build(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="A CARMEN, Wean Hall or CSV log.")],
    output: OutputFile,
    plot: PlotFile = None,
) -> None:
    """Build a vector map from a recorded drive.

    The drive's reference poses say where the walls are. A log that has none is matched scan to
    scan: good enough for a floor or two, but loops do not close by themselves.
    """
    import numpy as np
    from rich.console import Console

    from mend.localization.logs.reading import read_log
    from mend.localization.mapping import map_of
    from mend.localization.pictures.drive import PICTURE_SUFFIXES, save_map_picture
    from mend.localization.scan_matching import matched_poses
    from mend.maps.vector_map_file import write_vector_map

    checked_suffix("map", output, (".txt", ".json"))
    checked_suffix("picture", plot, PICTURE_SUFFIXES)
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    with told_plainly():
        read = read_log(log)
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

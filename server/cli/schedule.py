"""`mend schedule`: plan the deliveries of a file."""

from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.failures import NOT_FINISHED, CommandLineError, told_plainly
from mend.server.cli.rows import print_rows


def schedule(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="A delivery file (YAML or JSON) or an instance."),
    ],
    format_name: Annotated[
        str,
        typer.Option("--format", metavar="FORMAT", help="auto, problem, li_lim or transfers."),
    ] = "auto",
    method: Annotated[
        str,
        typer.Option(help="auto takes what suits; a name that is none lists those that there are."),
    ] = "auto",
    transfers: Annotated[
        bool, typer.Option(help="Whether items may change robots on their way.")
    ] = True,
    seconds: Annotated[
        float, typer.Option(min=0.1, max=86400.0, help="For how long to search.")
    ] = 10.0,
    seed: Annotated[int, typer.Option(min=0, help="The same seed draws the same.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the schedule and a map, as .svg.")] = None,
) -> None:
    """Plan who brings what when, with transfers between robots where they help.

    The exit code is 0 only if there is a schedule.
    """
    # Imported only here: solvers would make every other command wait.
    from mend.fleet.scheduling.drawing.picture import picture
    from mend.fleet.scheduling.methods import METHODS
    from mend.server.cli import schedule_output as output
    from mend.server.cli.delivery_files import read_delivery
    from mend.server.cli.delivery_search import Search, searched

    if method not in ("auto", *METHODS):
        names = ", ".join(("auto", *METHODS))
        raise CommandLineError(f"there is no method '{method}'; there are {names}")
    if plot is not None and plot.suffix != ".svg":
        raise CommandLineError(f"the picture's file has to end in .svg, which '{plot}' does not")
    with told_plainly():
        read = read_delivery(file, format_name, transfers=transfers)
        problem = read.problem
        measure = output.Measure(problem, read.robots_first)
        solution, why = searched(read, measure, Search(method, seconds, seed))
        summary = output.summary(measure, solution)
        if plot is not None and solution.schedule is not None:
            plot.parent.mkdir(parents=True, exist_ok=True)
            plot.write_text(picture(problem, solution.schedule, summary), encoding="utf-8")
    if as_json:
        typer.echo(output.as_json(measure, solution))
    elif solution.schedule is not None:
        typer.echo(summary)
        print_rows(output.table(problem, solution.schedule), output.HEADINGS)
    if solution.schedule is None:
        raise CommandLineError("\n".join(why), NOT_FINISHED)

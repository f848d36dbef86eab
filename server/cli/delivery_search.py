"""The search of `mend schedule`, told as it goes on; and why, where there is no schedule."""

import time
from dataclasses import dataclass

from rich.console import Console

from mend.fleet.scheduling.exact.infeasible_subset import infeasible_subset_words
from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.no_place import left_over_words
from mend.fleet.scheduling.solution import Solution, Status, UnsupportedError
from mend.server.cli import schedule_output as output
from mend.server.cli.delivery_files import ReadFile
from mend.server.cli.failures import INTERRUPTED, CommandLineError

EXPLAINING_S = 10.0
"""At most, and never more than the search was given."""


@dataclass(frozen=True, slots=True)
class Search:
    """How to search, and for how long."""

    method: str
    seconds: float
    seed: int


def searched(
    read: ReadFile, measure: output.Measure, search: Search
) -> tuple[Solution, tuple[str, ...]]:
    """The solution, and sentences about why there is no schedule, if there is none.

    Raises `CommandLineError` where the method cannot do the problem, and on Ctrl-C.
    """
    if read.infeasibilities:
        return Solution(Status.INFEASIBLE, None, None, None, 0.0), read.infeasibilities
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    try:
        with output.ProgressOutput(measure, console) as progress:
            solution = solve(
                read.problem,
                search.method,
                seconds=search.seconds,
                seed=search.seed,
                on_progress=progress.take,
                on_prepare=lambda: progress.say(output.PREPARING),
                clock=time.monotonic,
            )
            if solution.schedule is not None:
                return solution, ()
            progress.say(output.EXPLAINING)
            why = _explained(read, measure, search, solution)
            return solution, (f"{read.path}: {why}",)
    except UnsupportedError as error:
        raise CommandLineError(str(error)) from error
    except KeyboardInterrupt as error:
        raise CommandLineError("stopped before the search was over", INTERRUPTED) from error


def _explained(read: ReadFile, measure: output.Measure, search: Search, solution: Solution) -> str:
    """What clashes, where that is proved; else an item for which no place was found."""
    seconds = min(search.seconds, EXPLAINING_S)
    if solution.status is Status.INFEASIBLE:
        return infeasible_subset_words(read.problem, seconds=seconds, clock=time.monotonic)
    left_over = left_over_words(read.problem, seconds=seconds, clock=time.monotonic)
    summary = output.summary(measure, solution)
    return summary if left_over is None else f"{summary}; {left_over}"

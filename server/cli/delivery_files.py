"""The FILE of `mend schedule`: a delivery file or a published instance, told apart and read."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from mend.fleet.scheduling.infeasibility import infeasibilities
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.instances.numbers import InstanceError
from mend.fleet.scheduling.instances.transfer_benchmark import HEADER, read_transfer_benchmark
from mend.fleet.scheduling.problem import Problem, ProblemError
from mend.fleet.scheduling.problem_file import read_delivery_file
from mend.server.cli.failures import CommandLineError
from mend.server.cli.task_files import read_text

SUFFIXES = (".yaml", ".yml", ".json")
READERS: Mapping[str, Callable[[str, str], Problem]] = {
    "li_lim": read_li_lim,
    "transfers": read_transfer_benchmark,
}
FORMATS = ("auto", "problem", *READERS)


@dataclass(frozen=True, slots=True)
class ReadFile:
    """A problem, what certainly cannot hold in it, and whether robots count before distance."""

    path: Path
    problem: Problem
    infeasibilities: tuple[str, ...]
    robots_first: bool


def read_delivery(path: Path, format_name: str, *, transfers: bool) -> ReadFile:
    """Read a file of a format, or find out which it is; without transfers if so wanted.

    Raises `InvalidFileError` or `CommandLineError` with every mistake, and `OSError`.
    """
    if format_name not in FORMATS:
        raise CommandLineError(
            f"there is no format '{format_name}'; there are {', '.join(FORMATS)}"
        )
    text = read_text(path)
    kind = format_of(path, text) if format_name == "auto" else format_name
    if kind == "problem":
        delivery = read_delivery_file(path)
        if transfers:
            told = tuple(each.describe(str(path)) for each in delivery.infeasibilities)
            return ReadFile(path, delivery.problem, told, robots_first=False)
        problem = delivery.problem
    else:
        try:
            problem = READERS[kind](text, path.stem)
        except (InstanceError, ProblemError) as error:
            raise CommandLineError(f"{path}: {error}") from error
    problem = problem if transfers else problem.without_transfers()
    told = tuple(f"{path}: {each.sentence}" for each in infeasibilities(problem))
    return ReadFile(path, problem, told, robots_first=kind == "li_lim")


def format_of(path: Path, text: str) -> str:
    """The format of a text. Raises `CommandLineError` where it is none of them."""
    if path.suffix in SUFFIXES:
        return "problem"
    first = next((line.split() for line in text.splitlines() if line.strip()), [])
    if first == HEADER:
        return "transfers"
    if first and all(word.lstrip("-").replace(".", "", 1).isdigit() for word in first):
        return "li_lim"
    if any(":" in word or word in ("{", "---") for word in first) or text.lstrip().startswith(
        ("#", "{")
    ):
        return "problem"
    raise CommandLineError(
        f"'{path}' is neither a delivery file nor an instance of Li and Lim or with transfers; "
        "--format says which it is"
    )

"""The answers that a run is given on the command line."""

from typing import Literal, cast

from mend.server.cli.failures import CommandLineError

Answers = list[Literal["yes", "no", "silence"]] | Literal["random", "none"]

WORDS = ("yes", "no", "silence")


def read_answers(text: str) -> Answers:
    """Read `random`, `none`, or answers with commas between them. Raises `CommandLineError`."""
    if text in ("random", "none"):
        return cast(Literal["random", "none"], text)
    answers = [each.strip().lower() for each in text.split(",")]
    for number, answer in enumerate(answers, 1):
        if answer not in WORDS:
            raise CommandLineError(
                f"--answers: answer {number} is '{answer}'; it has to be yes, no or silence "
                "(or --answers is just random or none)"
            )
    return cast(list[Literal["yes", "no", "silence"]], answers)

"""Where a report is to be written."""

from pathlib import Path

from mend.server.cli.failures import CommandLineError


def require_writable(report: Path) -> None:
    """A report that cannot be written is told before what it is of, not after it.

    Makes its folder. Raises `CommandLineError`.
    """
    new = not report.exists()
    try:
        report.parent.mkdir(parents=True, exist_ok=True)
        report.open("ab").close()
    except OSError as error:
        why = error.strerror or error
        raise CommandLineError(
            f"--report '{report}' cannot be written ({why}): name a file that can be"
        ) from error
    if new:
        report.unlink()

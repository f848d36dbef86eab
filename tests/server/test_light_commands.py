"""What the command line brings into a process that says what there is, or asks a service."""

import subprocess
import sys

HEAVY = {"numpy", "cv2", "pydantic", "pydantic_settings", "fastapi", "scipy", "numba", "shapely"}

_LISTED = """
import sys
from mend.server.cli import main
sys.argv = ["mend", "--help"]
try:
    main()
finally:
    print(*sys.modules, file=sys.stderr)
"""

_EVERY_HELP = """
import sys
import typer
from mend.server.cli import app

def tell(command, parent=None):
    context = command.make_context(command.name, [], parent=parent, resilient_parsing=True)
    print(command.get_help(context))
    for name in getattr(command, "commands", ()):
        tell(command.resolve_command(context, [name])[1], context)

tell(typer.main.get_command(app))
print(*sys.modules, file=sys.stderr)
"""


def _loaded(program: str) -> tuple[str, set[str]]:
    """What a fresh process prints, and the heavy packages that it has imported."""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert "Usage: mend" in done.stdout, done.stderr
    return done.stdout, HEAVY & set(done.stderr.split())


def test_the_help_imports_nothing_that_commands_reckon_with() -> None:
    _, heavy = _loaded(_LISTED)
    assert heavy == set()


def test_nor_does_the_help_of_any_command() -> None:
    told, heavy = _loaded(_EVERY_HELP)
    # Typer itself takes some options with it.
    assert heavy <= {"pydantic"}
    assert "Add a principal" in told
    assert "Run a task tree in a simulated world" in told


def test_a_client_imports_nothing_that_a_service_is_made_of() -> None:
    program = "import sys, mend.server.cli.other_service\nprint(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    service = {"cryptography", "cv2", "fastapi", "numba", "scipy", "starlette", "uvicorn"}
    assert service & set(done.stdout.split()) == set()

"""Every test, in random order; a test in a browser that fails is run once more.

    python scripts/run_tests.py [arguments for pytest]

One that passes then is listed as flaky, and fails nothing; any other failure does.
"""

# ruff: noqa: T201

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parent.parent
BROWSER = "tests/e2e/"
SOME_FAILED = 1
"""pytest's exit code where tests have failed, and nothing worse has happened."""
WORKERS = ("-n", "3", "--dist", "worksteal")
"""More at a time than two cores: tests in a browser, and of processes, wait a good deal."""


def pytest(*arguments: str) -> int:
    return subprocess.run([sys.executable, "-m", "pytest", *arguments], cwd=ROOT).returncode


def last_failed() -> list[str]:
    """The tests that failed in the last run, as pytest's cache has them."""
    kept = ROOT / ".pytest_cache/v/cache/lastfailed"
    return sorted(json.loads(kept.read_text("utf-8"))) if kept.is_file() else []


def run(arguments: Sequence[str]) -> int:
    code = pytest("--cache-clear", *WORKERS, "-rs", *arguments)
    if code != SOME_FAILED:
        return code
    failed = last_failed()
    if not failed or not all(each.startswith(BROWSER) for each in failed):
        return code
    print(f"run once more: {len(failed)} in a browser")
    again = pytest("-rs", *failed)
    if again == 0:
        print("flaky, passed when run once more:", *failed, sep="\n  ")
    return again


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))

"""The tests that do only a sample in the suite, with everything that they can draw or repeat.

python benchmarks/whole_samples.py [arguments for pytest]
"""

import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from sampled import EVERYTHING

ROOT = Path(__file__).parents[1]
SAMPLING = (
    "from sampled import",
    "from forked_mend import",
    "from hypothesis import",
    "mark.drawn(",
)


def sampled_files() -> list[str]:
    """The test files of which any test is a sample, or has forks where a user has processes.

    Properties are samples unless they say how many examples they need.
    """
    tests = [(str(each), each.read_text("utf-8")) for each in (ROOT / "tests").rglob("test_*.py")]
    return sorted(file for file, text in tests if any(each in text for each in SAMPLING))


def main() -> int:
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", *sampled_files(), *sys.argv[1:]],
        cwd=ROOT,
        env=os.environ | {EVERYTHING: "1"},
    ).returncode


if __name__ == "__main__":
    sys.exit(main())

"""What becomes of tests that fail: one in a browser is run once more."""

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts/run_tests.py"
BROWSER = "tests/e2e/test_card.py::test_yes"
OTHER = "tests/tasks/test_tree.py::test_and"


@pytest.fixture
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("run_tests", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("codes", "failed", "ends", "runs"),
    [
        ([0], [], 0, 1),
        ([1, 0], [BROWSER], 0, 2),
        ([1, 1], [BROWSER], 1, 2),
        ([1], [OTHER], 1, 1),
        ([1], [BROWSER, OTHER], 1, 1),
        ([1], [], 1, 1),
        ([2], [BROWSER], 2, 1),
    ],
)
def test_only_tests_in_a_browser_get_a_second_try(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys, codes, failed, ends, runs
) -> None:
    asked: list[tuple[str, ...]] = []

    def run(*arguments: str) -> int:
        asked.append(arguments)
        return codes[len(asked) - 1]

    monkeypatch.setattr(script, "pytest", run)
    monkeypatch.setattr(script, "last_failed", lambda: failed)
    assert script.run([]) == ends
    assert len(asked) == runs
    assert all(each in asked[-1] for each in failed) == (runs == 2 or not failed)
    said = capsys.readouterr().out
    assert (f"flaky, passed when run once more:\n  {BROWSER}" in said) == (codes == [1, 0])


@pytest.mark.slow
@pytest.mark.parametrize("waits", ["await asyncio.Event().wait()", "threading.Event().wait()"])
def test_a_test_that_waits_for_ever_fails(waits: str, tmp_path: Path) -> None:
    test = tmp_path / "test_waiting.py"
    test.write_text(f"import asyncio, threading\n\nasync def test_it() -> None:\n    {waits}\n")
    root = SCRIPT.parent.parent
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    options = ["-c", str(root / "pyproject.toml"), "-o", "timeout=1", str(test)]
    done = subprocess.run([*command, *options], cwd=root, capture_output=True, text=True)
    assert done.returncode == 1
    assert "Timeout" in done.stdout

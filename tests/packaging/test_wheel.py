"""The wheel: everything that Mend reads at run time is in it, and nothing else is."""

import json
import os
import re
import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest
from sampled import sample

from mend.server.api.console import BUILT

ROOT = Path(__file__).parents[2]
PACKAGES = (
    "documents",
    "tasks",
    "maps",
    "dialogue",
    "localization",
    "robots",
    "fleet",
    "sim",
    "server",
)

ASSET = re.compile(r'"/(assets/[^"]+)"')
IMPORT = re.compile(r"""(?:\bfrom|\bimport)\s*\(?\s*["']\./([\w.-]+)["']""")

pytestmark = pytest.mark.slow(6)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of the sources as they are, built without network."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (built,) = folder.glob("mend_robots-*.whl")
    return built


def package_files() -> set[str]:
    """Every file of the packages, code or not."""
    own = {"mend/__init__.py", "mend/errors.py", "mend/garbage.py", "mend/py.typed"}
    return own | {
        f"mend/{path.relative_to(ROOT).as_posix()}"
        for package in PACKAGES
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_every_file_of_the_packages_is_in_the_wheel_and_no_other(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert names == package_files()
    assert {
        "mend/server/export/foxglove_schemas.json",
        "mend/tasks/library/eket.yaml",
        "mend/tasks/scenes/eket.yaml",
        "mend/tasks/scenarios/eket_paper.yaml",
        "mend/server/dialogues/mail_request.txt.j2",
        "mend/server/report/templates/report.html",
    } <= names


@pytest.mark.skipif(
    not (BUILT / "index.html").is_file(), reason="the console is not built (make console)"
)
def test_console_in_the_wheel_has_every_asset_that_it_names(wheel: Path) -> None:
    folder = "mend/server/api/console/built/"
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if name.startswith(folder)}
        written = (name for name in names if not name.endswith((".gz", ".png")))
        text = {name: archive.read(name).decode() for name in written}
    assert f"{folder}icon.svg" in names
    named = set(ASSET.findall(text[f"{folder}index.html"]))
    assert {Path(name).suffix for name in named} == {".js", ".css"}
    for script in (each for each in text if each.endswith(".js")):
        named |= {f"assets/{each}" for each in IMPORT.findall(text[script])}
    assert {f"{folder}{each}" for each in named} <= names
    assert {f"{name}.gz" for name in text} <= names
    icons = json.loads(text[f"{folder}manifest.webmanifest"])["icons"]
    assert {f"{folder}{icon['src'].removeprefix('/')}" for icon in icons} <= names


def test_wheel_says_its_licence_and_keeps_pybullet_an_extra(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith("/METADATA"))
        fields = Parser().parsestr(archive.read(metadata).decode())
        assert any(name.endswith("/licenses/LICENSE") for name in archive.namelist())
    assert fields["License-Expression"] == "MIT"
    (pybullet,) = (each for each in fields.get_all("Requires-Dist", []) if "pybullet" in each)
    assert "extra == 'workcell'" in pybullet


def test_unpacked_wheel_works_anywhere_and_takes_nothing_from_the_working_folder(
    wheel: Path, tmp_path: Path
) -> None:
    """A task is checked: a run would compile every kernel anew.

    And in the benchmarks all of it is loaded, which compiles every module.
    """
    installed, elsewhere = tmp_path / "installed", tmp_path / "some where"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(installed)
    elsewhere.mkdir()
    for module in (*PACKAGES, "yaml", "numpy", "typing"):
        (elsewhere / f"{module}.py").write_text("raise RuntimeError('the wrong module')\n")
    load_all = (
        "import mend, pkgutil; from importlib import import_module; "
        "[import_module(each.name) for each in pkgutil.walk_packages(mend.__path__, 'mend.') "
        "if not each.name.endswith('__main__')]; "
    )
    start = (
        "import sys; sys.path.insert(0, sys.argv.pop(1)); "
        f"{sample('', load_all)}"
        "from mend.server.cli import main, __file__; "
        "assert __file__.startswith(sys.path[0]); main()"
    )
    task = installed / "mend/tasks/library/eket.yaml"
    environment = {name: value for name, value in os.environ.items() if name[:5] != "MEND_"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", start, str(installed), "check", task, "--world", "tabletop"],
        cwd=elsewhere,
        env=environment | {"XDG_DATA_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "a task file without mistakes in the world 'tabletop'" in done.stdout


def test_a_users_own_modules_stand_beside_ours(wheel: Path, tmp_path: Path) -> None:
    installed = tmp_path / "installed"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(installed)
    for module in PACKAGES:
        (tmp_path / f"{module}.py").write_text("OWN = True\n")
    names = ", ".join(PACKAGES)
    program = (
        f"import {names}; assert all(each.OWN for each in ({names})); "
        "import mend, mend.tasks.task_tree, mend.server.settings; print(mend.__file__)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert Path(done.stdout.strip()) == installed / "mend" / "__init__.py"

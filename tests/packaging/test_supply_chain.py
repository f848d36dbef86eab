"""What is installed: nothing but what the lock files name, byte by byte, and a list of it all."""

import importlib.util
import json
import re
import tomllib
from collections import Counter
from importlib.resources import files
from pathlib import Path
from types import ModuleType
from typing import Any

import jsonschema_rs
import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
PINNED = re.compile(r"^[A-Za-z0-9._-]+==[^ ]+( ; .+)?( --hash=sha256:[0-9a-f]{64})+$")


LOCKS = ("requirements.lock", "docker/service.lock", "docker/tools.lock")


def locked_lines(name: str = "requirements.lock") -> list[str]:
    lock = re.sub(r" *\\\n *", " ", (ROOT / name).read_text())
    return [line for line in lock.splitlines() if not line.startswith("#")]


def npm_packages() -> dict[str, Any]:
    lock = json.loads((ROOT / "web/package-lock.json").read_text())
    return {path: package for path, package in lock["packages"].items() if path}


@pytest.mark.parametrize("name", LOCKS)
def test_every_python_package_is_pinned_with_the_hashes_of_its_files(name: str) -> None:
    lines = locked_lines(name)
    assert len(lines) >= 8
    assert [line[:60] for line in lines if not PINNED.match(line)] == []


def test_all_that_pyproject_and_the_build_require_is_locked() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    locked = {canonicalize_name(line.partition("==")[0]) for line in locked_lines()}
    wanted = [
        *project["build-system"]["requires"],
        *project["project"]["dependencies"],
        *(each for extra in project["project"]["optional-dependencies"].values() for each in extra),
        *(ROOT / "requirements-build.in").read_text().split(),
    ]
    # An extra may contain another one.
    own = {canonicalize_name(project["project"]["name"])}
    assert {canonicalize_name(Requirement(each).name) for each in wanted} - locked <= own


@pytest.mark.parametrize("name", LOCKS[1:])
def test_images_are_made_of_what_developers_test_with(name: str) -> None:
    def without_marker(lines: list[str]) -> set[str]:
        return {re.sub(r" ; .+?(?= --hash)", "", line) for line in lines}

    assert without_marker(locked_lines(name)) - without_marker(locked_lines()) == set()


def test_setup_installs_nothing_that_has_no_hash() -> None:
    installs = re.findall(r"^install (.+)$", (ROOT / "scripts/setup").read_text(), re.MULTILINE)
    assert installs == [
        "--require-hashes -r requirements.lock",
        "--no-deps --no-build-isolation -e .",
    ]


def test_every_npm_package_is_locked_with_its_digest() -> None:
    packages = npm_packages()
    assert len(packages) > 100
    lacking = [
        path
        for path, package in packages.items()
        if not package.get("integrity", "").startswith("sha512-")
    ]
    assert lacking == []


@pytest.mark.parametrize("lock", [*LOCKS, "web/package-lock.json"])
def test_no_lock_file_names_a_registry(lock: str) -> None:
    text = (ROOT / lock).read_text()
    assert re.findall(r'"resolved"|--(?:extra-)?index-url|--find-links|\.tgz"', text) == []


@pytest.fixture(scope="module")
def sbom(tmp_path_factory: pytest.TempPathFactory) -> Any:
    spec = importlib.util.spec_from_file_location("sbom", ROOT / "scripts/sbom.py")
    assert spec is not None
    assert spec.loader is not None
    script: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    file = tmp_path_factory.mktemp("sbom") / "new" / "mend.cdx.json"
    script.main(file)
    return json.loads(file.read_text())


def test_bill_of_materials_is_valid_cyclonedx(sbom: Any) -> None:
    folder = files("cyclonedx.schema._res")

    def local(uri: str) -> Any:
        return json.loads((folder / uri.rpartition("/")[2]).read_text())

    schema = local("bom-1.6.SNAPSHOT.schema.json")
    validator = jsonschema_rs.Draft7Validator(schema, retriever=local)
    assert [each.message for each in validator.iter_errors(sbom)] == []
    assert not validator.is_valid({**sbom, "components": [{"type": "library"}]})


def test_bill_of_materials_has_every_locked_package_of_both_kinds(sbom: Any) -> None:
    purls = Counter(each["purl"] for each in sbom["components"])
    pinned = (line.partition(" ")[0].split("==") for line in locked_lines())
    python = {f"pkg:pypi/{name}@{version}" for name, version in pinned}
    npm = {
        f"pkg:npm/{path.rpartition('node_modules/')[2].replace('@', '%40')}@{package['version']}"
        for path, package in npm_packages().items()
    }
    assert set(purls) == python | npm
    assert set(purls.values()) == {1}
    assert all(each["hashes"] for each in sbom["components"])
    assert sbom["metadata"]["component"]["name"] == "mend-robots"


def test_bill_of_materials_says_what_a_service_needs_and_what_only_developers_do(sbom: Any) -> None:
    required = {each["name"] for each in sbom["components"] if each["scope"] == "required"}
    assert {"fastapi", "starlette", "pydantic-core", "pybullet", "pocketsphinx"} <= required
    assert {"preact", "three"} <= required
    assert required & {"pytest", "mypy", "ruff", "uv", "pyvrp", "vite", "typescript"} == set()

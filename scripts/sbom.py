"""A bill of materials (CycloneDX 1.6, JSON) of Mend: every package of its two lock files.

    python scripts/sbom.py out/mend.cdx.json

What only builds, checks or tests Mend is in it with the scope `excluded`.
"""

import base64
import json
import sys
import tomllib
from collections.abc import Iterable, Iterator
from importlib.metadata import PackageNotFoundError, metadata, requires
from pathlib import Path
from typing import Any

from cyclonedx.contrib.license.factories import LicenseFactory
from cyclonedx.model import HashAlgorithm, HashType
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentScope, ComponentType
from cyclonedx.model.license import License
from cyclonedx.output import make_outputter
from cyclonedx.schema import OutputFormat, SchemaVersion
from packageurl import PackageURL
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]

NOT_AT_RUN_TIME = frozenset({"dev", "peers"})
"""The extras that a service never needs."""

LICENSES = LicenseFactory()


def locked_python(lock: str) -> Iterator[tuple[Requirement, list[str]]]:
    """A lock file's requirements, and the SHA-256 of each file that may be installed for one."""
    for line in lock.replace("\\\n", "").splitlines():
        if line and not line.startswith("#"):
            required, *hashes = line.split("--hash=sha256:")
            yield Requirement(required.strip()), [each.strip() for each in hashes]


def needed_at_run_time(wanted: Iterable[str]) -> set[str]:
    """The names of these requirements and all that they require, on whatever platform."""
    found: set[str] = set()
    waiting = [(Requirement(each), "") for each in wanted]
    while waiting:
        requirement, extra = waiting.pop()
        if not _concerns(requirement, extra):
            continue
        name = canonicalize_name(requirement.name)
        extras = {"", *requirement.extras}
        if name in found and extras == {""}:
            continue
        found.add(name)
        for each in _requires(requirement.name):
            waiting += [(Requirement(each), extra) for extra in extras]
    return found


def _concerns(requirement: Requirement, extra: str) -> bool:
    """Whether a requirement holds with an extra; one of another platform holds too."""
    marker = requirement.marker
    return marker is None or "extra" not in str(marker) or marker.evaluate({"extra": extra})


def _requires(name: str) -> list[str]:
    # What is for other platforms is not installed here, and what it requires is not known.
    try:
        return requires(name) or []
    except PackageNotFoundError:
        return []


def _python_license(name: str) -> Iterator[License]:
    try:
        told = metadata(name)
    except PackageNotFoundError:
        return
    classified = [
        each.rpartition(" :: ")[2]
        for each in told.get_all("Classifier", [])
        if each.startswith("License :: OSI Approved :: ")
    ]
    # Some have the whole text where its name belongs.
    named = told["License-Expression"] or told["License"]
    if named and "\n" not in named:
        yield LICENSES.make_from_string(named)
    elif classified:
        yield LICENSES.make_with_name(" or ".join(classified))


def python_components(project: dict[str, Any], lock: str) -> Iterator[Component]:
    """A component for each locked package."""
    extras = project["optional-dependencies"]
    wanted = [
        *project["dependencies"],
        *(each for extra in extras.keys() - NOT_AT_RUN_TIME for each in extras[extra]),
    ]
    needed = needed_at_run_time(wanted)
    for requirement, hashes in locked_python(lock):
        name = canonicalize_name(requirement.name)
        (pinned,) = requirement.specifier
        purl = PackageURL("pypi", name=name, version=pinned.version)
        yield Component(
            type=ComponentType.LIBRARY,
            name=name,
            version=pinned.version,
            purl=purl,
            bom_ref=str(purl),
            scope=ComponentScope.REQUIRED if name in needed else ComponentScope.EXCLUDED,
            licenses=_python_license(requirement.name),
            hashes=[HashType(alg=HashAlgorithm.SHA_256, content=each) for each in hashes],
        )


def npm_components(lock: dict[str, Any]) -> Iterator[Component]:
    """A component for each package of the console; the same one in two places is one."""
    found: dict[str, Component] = {}
    for path, package in lock["packages"].items():
        if not path:
            continue
        full = package.get("name") or path.rpartition("node_modules/")[2]
        scope, _, name = full.rpartition("/")
        purl = PackageURL("npm", namespace=scope or None, name=name, version=package["version"])
        used = not (package.get("dev") or package.get("devOptional"))
        known = found.get(str(purl))
        if known is not None:
            if used:
                known.scope = ComponentScope.REQUIRED
            continue
        algorithm, _, digest = package["integrity"].partition("-")
        assert algorithm == "sha512", f"{full} has the digest of another algorithm: {algorithm}"
        found[str(purl)] = Component(
            type=ComponentType.LIBRARY,
            group=scope or None,
            name=name,
            version=package["version"],
            purl=purl,
            bom_ref=str(purl),
            scope=ComponentScope.REQUIRED if used else ComponentScope.EXCLUDED,
            licenses=[LICENSES.make_from_string(package["license"])],
            hashes=[
                HashType(alg=HashAlgorithm.SHA_512, content=base64.b64decode(digest).hex())
            ],
        )  # fmt: skip
    yield from found.values()


def bill_of_materials() -> Bom:
    """Mend, and all that is locked for it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    bom = Bom()
    bom.metadata.component = Component(
        type=ComponentType.APPLICATION,
        name=project["name"],
        version=project["version"],
        licenses=[LICENSES.make_from_string(project["license"])],
        bom_ref=project["name"],
    )
    parts = [
        *python_components(project, (ROOT / "requirements.lock").read_text()),
        *npm_components(json.loads((ROOT / "web/package-lock.json").read_text())),
    ]
    for each in parts:
        bom.components.add(each)
    bom.register_dependency(
        bom.metadata.component, [each for each in parts if each.scope is ComponentScope.REQUIRED]
    )
    return bom


def main(out: Path) -> None:
    out.parent.mkdir(parents=True, exist_ok=True)
    outputter = make_outputter(bill_of_materials(), OutputFormat.JSON, SchemaVersion.V1_6)
    outputter.output_to_file(str(out), allow_overwrite=True, indent=2)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

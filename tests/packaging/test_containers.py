"""What the images and the compose file promise: few rights, known bytes, no known secret."""

import re
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[2]
DOCKERFILE = (ROOT / "docker/Dockerfile").read_text()
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "docker/docker-compose.yml").read_text())
SERVICES: dict[str, Any] = COMPOSE["services"]


def instructions(text: str) -> list[str]:
    """A Dockerfile's instructions, one a line, without comments."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    return re.sub(r"\\\n\s*", " ", "\n".join(lines)).split("\n")


def stages() -> dict[str, list[str]]:
    """The instructions of each named stage."""
    found: dict[str, list[str]] = {}
    name = ""
    for line in instructions(DOCKERFILE):
        if line.startswith("FROM "):
            name = line.partition(" AS ")[2]
        found.setdefault(name, []).append(line)
    return found


@pytest.mark.parametrize("name", SERVICES)
def test_a_container_may_do_nothing_that_it_need_not(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert not {"privileged", "cap_add", "devices", "pid", "ipc", "network_mode"} & service.keys()
    assert not any("docker.sock" in str(each) for each in service.get("volumes", []))


@pytest.mark.parametrize("name", SERVICES)
def test_a_container_has_bounds_and_a_tmp_in_memory(name: str) -> None:
    service = SERVICES[name]
    assert {"mem_limit", "memswap_limit", "pids_limit"} <= service.keys()
    assert 0 < service["pids_limit"] <= 1024
    (tmp,) = service["tmpfs"]
    path, _, options = tmp.partition(":")
    assert path == "/tmp"
    assert {"noexec", "nosuid", "nodev"} <= set(options.split(","))
    assert re.search(r"\bsize=\d+m\b", options)


def test_the_journal_is_on_a_volume() -> None:
    assert SERVICES["mend"]["volumes"] == ["data:/data"]
    assert "data" in COMPOSE["volumes"]
    assert "MEND_DATA_DIR=/data" in DOCKERFILE


@pytest.mark.parametrize("name", SERVICES)
def test_no_container_has_a_token_that_others_know(name: str) -> None:
    assert re.fullmatch(r"\$\{MEND_TOKEN:\?.+\}", SERVICES[name]["environment"]["MEND_TOKEN"])
    assert "TOKEN=" not in DOCKERFILE


def test_ports_are_published_on_this_machine_alone() -> None:
    assert all(each.startswith("127.0.0.1:") for each in SERVICES["mend"]["ports"])
    assert "ports" not in SERVICES["demo"]


def test_every_stage_is_made_of_the_one_base_that_can_be_given_by_its_digest() -> None:
    bases = [line.split()[1] for line in instructions(DOCKERFILE) if line.startswith("FROM ")]
    assert bases[0] == "${BASE_IMAGE}"
    assert set(bases[1:]) - {"scratch"} <= stages().keys()
    assert re.search(r"^ARG BASE_IMAGE=\S+$", DOCKERFILE, re.MULTILINE)
    for service in SERVICES.values():
        assert service["build"]["args"]["BASE_IMAGE"].startswith("${BASE_IMAGE:-")


def test_images_run_as_a_user_of_their_own_who_owns_nothing_of_the_program() -> None:
    service = stages()["service"]
    assert "USER mend" in service
    assert service.index("USER mend") > next(
        index for index, line in enumerate(service) if line.startswith("COPY")
    )
    owned = [line.split()[-1] for line in service if "--chown" in line]
    assert owned == ["/data"]
    assert not any(line.startswith("USER") for line in stages()["demo"])


def test_the_environment_is_relieved_of_what_no_service_needs() -> None:
    assert (ROOT / "docker/slim.sh").stat().st_mode & 0o111
    assert any("&& docker/slim.sh /opt/mend/" in line for line in stages()["build"])


def test_an_image_begins_with_nothing_and_gets_what_it_needs_to_run() -> None:
    service = stages()["service"]
    assert service[0] == "FROM scratch AS service"
    # There is no shell to run anything with, while it is built and afterwards.
    for name in ("service", "demo"):
        assert not any(line.startswith(("RUN", "SHELL")) for line in stages()[name])
        for line in stages()[name]:
            if line.startswith(("CMD", "ENTRYPOINT")):
                assert line.partition(" ")[2].startswith("[")
    assert "COPY --from=system /service /" in service


def test_what_a_build_copies_from_here_enters_it() -> None:
    allowed = (ROOT / ".dockerignore").read_text().splitlines()
    files = [
        file
        for lines in stages().values()
        for line in lines
        if line.startswith("COPY docker/")
        for file in line.split()[1:-1]
    ]
    assert len(files) >= 4
    for file in files:
        assert (ROOT / file).is_file()
        assert any(fnmatch(file, each.removeprefix("!")) for each in allowed if each[:1] == "!")


def test_pip_installs_nothing_whose_hash_is_not_locked() -> None:
    installs = [
        command
        for line in stages()["build"]
        for command in line.split("&&")
        if re.search(r"\bpip\b.* install\b", command)
    ]
    assert len(installs) == 3
    for command in installs:
        assert "--require-hashes" in command or "--no-deps /tmp/mend_robots-*.whl" in command


def test_every_folder_of_the_package_enters_the_build() -> None:
    allowed = (ROOT / ".dockerignore").read_text().splitlines()
    folders = {each.name for each in (ROOT / "src/mend").iterdir() if each.is_symlink()}
    assert {"server", "localization"} <= folders
    assert {"!src", *(f"!{each}" for each in folders)} <= set(allowed)

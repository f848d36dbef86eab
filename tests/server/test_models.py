"""Model files are served with what caches need, and nothing outside their folder ever is."""

from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from service_under_test import build

from mend.errors import NotFoundError
from mend.server.models.robot_models import WorldModels
from mend.sim.world import WorldUnavailableError


@dataclass(frozen=True)
class Drawn:
    """What of a world adapter provides a model."""

    folder: Path
    model: str = "box"

    def model_folder(self) -> Path:
        return self.folder


class NotInstalled:
    model = "absent"

    def model_folder(self) -> Path:
        raise WorldUnavailableError("install it")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "model"
    (folder / "meshes").mkdir(parents=True)
    (folder / "robot.urdf").write_text("<robot/>")
    (folder / "meshes" / "arm.stl").write_bytes(b"mesh")
    (folder / "notes.txt").write_text("ours")
    (tmp_path / "secret.stl").write_text("secret")
    (folder / "link.stl").symlink_to(tmp_path / "secret.stl")
    return folder


@pytest.fixture
async def client(folder: Path) -> AsyncIterator[httpx.AsyncClient]:
    service = build(models=[Drawn(folder), NotInstalled()])
    async with service.client() as client:
        yield client
    service.journal.close()


async def test_a_description_and_its_meshes_are_served(client: httpx.AsyncClient) -> None:
    urdf = await client.get("/api/models/box/robot.urdf")
    assert (urdf.status_code, urdf.text) == (200, "<robot/>")
    assert urdf.headers["content-type"].startswith("application/xml")
    assert "max-age" in urdf.headers["cache-control"]
    mesh = await client.get("/api/models/box/meshes/arm.stl")
    assert mesh.content == b"mesh"
    assert mesh.headers["content-type"] == "model/stl"


async def test_a_file_that_has_not_changed_is_not_sent_again(client: httpx.AsyncClient) -> None:
    first = await client.get("/api/models/box/robot.urdf")
    known = {"If-None-Match": first.headers["etag"]}
    again = await client.get("/api/models/box/robot.urdf", headers=known)
    assert (again.status_code, again.content) == (304, b"")
    other = await client.get("/api/models/box/robot.urdf", headers={"If-None-Match": '"x"'})
    assert other.status_code == 200


@pytest.mark.parametrize(
    "path",
    [
        "box/nothing.stl",
        "box/meshes",
        "box/notes.txt",
        "box/link.stl",
        "box/%2e%2e/secret.stl",
        "box/..%2fsecret.stl",
        "box/meshes/..%2f..%2f..%2fsecret.stl",
        "box/%2fetc%2fpasswd",
        "box/%00.stl",
        "box/" + "a" * 250 + ".stl",
        "nobody/robot.urdf",
        "absent/robot.urdf",
    ],
)
async def test_anything_else_is_not_found(client: httpx.AsyncClient, path: str) -> None:
    response = await client.get(f"/api/models/{path}")
    assert response.status_code == 404
    assert response.headers["content-type"] == "application/problem+json"
    assert "secret" not in response.text.replace("secret.stl", "")


@pytest.mark.parametrize("name", ["../secret.stl", "meshes/../../secret.stl", "/etc/passwd", "\0"])
def test_a_name_never_leads_out_of_the_folder(folder: Path, name: str) -> None:
    with pytest.raises(NotFoundError):
        WorldModels([Drawn(folder)]).file("box", name)  # type: ignore[list-item]


def test_a_model_has_an_address_where_its_files_are(folder: Path) -> None:
    models = WorldModels([Drawn(folder), NotInstalled()])  # type: ignore[list-item]
    assert models.address("box") == "/api/models/box/robot.urdf"
    assert models.address("absent") is None
    assert models.address("nobody") is None

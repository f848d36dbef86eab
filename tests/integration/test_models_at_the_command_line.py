"""Models of robots at the command line: listed, given, fetched and deleted."""

from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from console_script import Command, Outcome, command_of
from gated_robot import gated_robot
from small_model import BARE, FILES, packed

from mend.server.composition import Service, open_service
from mend.server.settings import Settings

TOKEN = "a-token"
SHOWS = {"model": "lamp", "joints": ["elbow"], "objects": []}


@pytest.fixture
async def service(tmp_path: Path) -> AsyncIterator[Service]:
    settings = Settings(
        data_dir=tmp_path / "data", port=0, token=TOKEN, speech_voice="none", log_level="warning"
    )
    async with open_service(settings) as service:
        yield service


@pytest.fixture
def model(
    service: Service, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Command:
    """`mend model`, of that service."""
    command = command_of("model", monkeypatch, capsys)

    async def call(*arguments: object) -> Outcome:
        return await command(service.url, *map(str, arguments), "--token", TOKEN)

    return call


def in_folder(folder: Path) -> Path:
    """The lamp as its files."""
    for name, content in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


async def test_a_model_is_given_listed_with_its_robot_fetched_and_deleted(
    service: Service, model: Command, tmp_path: Path
) -> None:
    async with gated_robot(service.robots_url, TOKEN, "demo", shows=SHOWS):
        given = await model("put", "lamp", in_folder(tmp_path / "lamp"))
        assert (given.code, given.complaints) == (0, "")
        assert given.told == "the robot model 'lamp' is kept: 4 files\n"
        size = sum(map(len, FILES.values()))
        listed = (await model("list")).told.splitlines()
        assert f"lamp\tuploaded\t{size}\tdemo" in listed
    archive = tmp_path / "fetched.zip"
    assert (await model("get", "lamp", archive)).code == 0
    assert (await model("put", "twin", archive)).code == 0
    (tmp_path / "post.urdf").write_text(BARE)
    alone = await model("put", "twin", tmp_path / "post.urdf")
    assert alone.told == "the robot model 'twin' is kept: 1 file\n"
    assert (await model("delete", "twin")).told == "the robot model 'twin' is deleted\n"
    gone = await model("delete", "twin")
    assert (gone.code, gone.complaints) == (2, "mend: there is no robot model 'twin'\n")


async def test_what_is_no_model_is_told_in_a_sentence(model: Command, tmp_path: Path) -> None:
    nowhere = await model("put", "lamp", tmp_path / "none.zip")
    assert nowhere.complaints == f"mend: '{tmp_path / 'none.zip'}': No such file or directory\n"
    (tmp_path / "empty").mkdir()
    empty = await model("put", "lamp", tmp_path / "empty")
    assert empty.complaints.endswith("is no robot model: it has no robot.urdf\n")
    (tmp_path / "torn.zip").write_bytes(packed({"meshes/base.obj": None}))
    torn = await model("put", "lamp", tmp_path / "torn.zip")
    assert (torn.code, torn.complaints) == (
        2, "mend: robot.urdf needs meshes/base.obj, which is not in the archive\n",
    )  # fmt: skip
    fetched = await model("get", "lamp", tmp_path / "lamp.zip")
    assert fetched.complaints == "mend: there is no robot model 'lamp'\n"
    assert not (tmp_path / "lamp.zip").exists()

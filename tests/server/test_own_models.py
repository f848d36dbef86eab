"""Uploaded models are kept over restarts, replaced and deleted; what is refused changes nothing."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextvars import copy_context
from datetime import UTC, datetime
from pathlib import Path
from typing import ParamSpec, TypeVar

import httpx
import pytest
from languages_of_console import refused_in_every_language, untold
from people import serving_people
from service_under_test import ServiceUnderTest, build
from small_model import BARE, DESCRIPTION, OBJ, STL, packed

from mend.errors import ConflictError, NotFoundError, UnavailableError, WrongInputError
from mend.server.access.deeds import deed_of
from mend.server.access.roles import Role
from mend.server.api.body_sizes import MODEL_BODY_BYTES
from mend.server.api.gate import TOO_MANY_BODIES
from mend.server.asking import asker
from mend.server.errors import BusyError
from mend.server.journal import events as ev
from mend.server.journal.journal import JournalWriteError
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.models.own_model import OwnModel
from mend.server.models.own_models import OwnModels
from mend.server.off_loop import OffLoop

P = ParamSpec("P")
T = TypeVar("T")

ZIP, XML = {"Content-Type": "application/zip"}, {"Content-Type": "application/xml"}
ANNA = ev.Author(principal="anna", role=Role.OPERATOR, address=None)


@pytest.fixture
async def service(tmp_path: Path) -> AsyncIterator[ServiceUnderTest]:
    service = build(journal=tmp_path / "journal.db")
    yield service
    service.journal.close()


@pytest.fixture
async def client(service: ServiceUnderTest) -> AsyncIterator[httpx.AsyncClient]:
    async with service.client() as client:
        yield client


def own_models(
    folder: Path,
    journal: SqliteJournal,
    limits: Limits | None = None,
    off_loop: OffLoop | None = None,
) -> OwnModels:
    return OwnModels(
        folder,
        journal,
        limits or Limits(),
        off_loop or OffLoop(),
        utc_now=lambda: datetime.now(UTC),
        taken=lambda name: name == "pr2",
    )


async def test_a_model_is_kept_listed_served_and_deleted(client: httpx.AsyncClient) -> None:
    kept = await client.put("/api/models/arm 1", content=packed(), headers=ZIP)
    assert kept.status_code == 201, kept.text
    view = kept.json()
    assert view["urdf"] == f"/api/models/arm%201/{view['version']}/robot.urdf"
    assert {each["name"]: each["bytes"] for each in view["files"]} == {
        "robot.urdf": len(DESCRIPTION),
        "lamp/meshes/foot.stl": len(STL),
        "meshes/base.obj": len(OBJ),
        "meshes/shade.dae": view["files"][2]["bytes"],
    }
    assert (await client.get("/api/models")).json() == [view]
    served = await client.get(view["urdf"])
    assert (served.status_code, served.text) == (200, DESCRIPTION)
    assert served.headers["content-security-policy"].startswith("default-src 'none'")
    mesh = await client.get(view["urdf"].replace("robot.urdf", "lamp/meshes/foot.stl"))
    assert (mesh.content, mesh.headers["content-type"]) == (STL, "model/stl")
    known = {"If-None-Match": served.headers["etag"]}
    assert (await client.get(view["urdf"], headers=known)).status_code == 304
    assert (await client.delete("/api/models/arm 1")).status_code == 204
    assert (await client.get(view["urdf"])).status_code == 404
    assert (await client.delete("/api/models/arm 1")).status_code == 404
    assert (await client.get("/api/models")).json() == []


async def test_a_replaced_model_has_another_address(client: httpx.AsyncClient) -> None:
    first = (await client.put("/api/models/lamp", content=packed(), headers=ZIP)).json()
    again = await client.put("/api/models/lamp", content=BARE, headers=XML)
    assert again.status_code == 200
    assert again.json()["version"] != first["version"]
    assert (await client.get(first["urdf"])).status_code == 404
    assert (await client.get(again.json()["urdf"])).text == BARE
    assert (await client.get("/api/models/lamp/robot.urdf")).text == BARE


@pytest.mark.parametrize(
    ("content", "headers", "status", "why"),
    [
        (b"{}", {"Content-Type": "application/json"}, 415, "send the model as application/zip"),
        (b"no archive", ZIP, 422, "the archive cannot be read"),
        (packed({"meshes/base.obj": None}), ZIP, 422, "needs meshes/base.obj"),
        (DESCRIPTION.encode(), XML, 422, "send both in one archive"),
    ],
)
async def test_what_is_refused_leaves_what_was_there(
    client: httpx.AsyncClient, content: bytes, headers: dict[str, str], status: int, why: str
) -> None:
    before = (await client.put("/api/models/lamp", content=packed(), headers=ZIP)).json()
    refused = await client.put("/api/models/lamp", content=content, headers=headers)
    assert refused.status_code == status
    assert refused.headers["content-type"] == "application/problem+json"
    detail = refused.json()["detail"]
    assert why in detail
    assert untold([detail], ["clauses", "refusals"]) == []
    assert (await client.get("/api/models")).json() == [before]
    assert (await client.get(before["urdf"])).text == DESCRIPTION


async def test_a_model_is_fetched_whole_and_may_be_given_again(client: httpx.AsyncClient) -> None:
    kept = (await client.put("/api/models/arm 1", content=packed(), headers=ZIP)).json()
    fetched = await client.get("/api/models/arm 1")
    assert fetched.headers["content-type"] == "application/zip"
    assert fetched.headers["content-length"] == str(len(fetched.content))
    known = {"If-None-Match": fetched.headers["etag"]}
    assert (await client.get("/api/models/arm 1", headers=known)).status_code == 304
    again = await client.put("/api/models/twin", content=fetched.content, headers=ZIP)
    assert again.json() == {**kept, "name": "twin", "urdf": again.json()["urdf"]}
    nothing = await client.get("/api/models/other")
    assert untold([nothing.json()["detail"]], ["refusals"]) == []
    assert (nothing.status_code, nothing.json()["detail"]) == (
        404, "there is no robot model 'other'",
    )  # fmt: skip


async def test_so_many_are_checked_or_wait_for_it_at_a_time(tmp_path: Path) -> None:
    checking, may_end = asyncio.Event(), asyncio.Event()

    class Slow(OffLoop):
        async def run(
            self, chars: int, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs
        ) -> T:
            checking.set()
            await may_end.wait()
            return await super().run(chars, work, *args, **kwargs)

    journal = SqliteJournal(":memory:")
    models = own_models(tmp_path / "models", journal, Limits(waiting_models=2), Slow())

    def keep(who: str, name: str) -> asyncio.Task[tuple[OwnModel, bool]]:
        context = copy_context()
        context.run(asker.set, who)
        kept = models.keep(name, BARE.encode(), ANNA, packed=False)
        return asyncio.create_task(kept, context=context)

    taken = [keep("anna", "lamp"), keep("anna", "post")]
    await checking.wait()
    with refused_in_every_language(BusyError, "too many robot models wait") as refused:
        await keep("anna", "arm")
    assert refused.value.limit == "waiting_models"
    # One of each is taken however many wait.
    taken.append(keep("ben", "crane"))
    may_end.set()
    await asyncio.gather(*taken)
    assert [each.name for each in models.all()] == ["crane", "lamp", "post"]
    journal.close()


async def test_a_large_file_is_served_whole(client: httpx.AsyncClient) -> None:
    large = OBJ + b"v 0 0 0\n" * 10**5
    sent = packed({"meshes/base.obj": large})
    kept = (await client.put("/api/models/lamp", content=sent, headers=ZIP)).json()
    served = await client.get(kept["urdf"].replace("robot.urdf", "meshes/base.obj"))
    assert served.content == large
    assert served.headers["content-length"] == str(len(large))


async def test_a_version_that_is_replaced_meanwhile_is_gone_and_no_other(tmp_path: Path) -> None:
    journal = SqliteJournal(":memory:")
    models = own_models(tmp_path / "models", journal)
    before, _ = await models.keep("lamp", packed(), ANNA, packed=True)
    after, _ = await models.keep("lamp", BARE.encode(), ANNA, packed=False)
    for file in ("robot.urdf", "meshes/base.obj"):
        with refused_in_every_language(NotFoundError, "of this version any more"):
            before.read(file)
    assert after.read("robot.urdf").decode() == BARE
    journal.close()


async def test_robots_give_their_own_model_and_no_other(tmp_path: Path) -> None:
    async with serving_people(tmp_path) as (service, people):
        robot = people.headers(Role.ROBOT)
        async with httpx.AsyncClient(base_url=service.url) as client:
            put = await client.put(
                "/api/robots/own_model", content=packed(), headers={**robot, **ZIP}
            )
            assert put.status_code == 201, put.text
            refused = await client.put(
                "/api/models/other", content=packed(), headers={**robot, **ZIP}
            )
            assert refused.status_code == 403
            viewer = people.headers(Role.VIEWER)
            listed = (await client.get("/api/models", headers=viewer)).json()
            assert [each["name"] for each in listed] == [put.json()["name"]]
            gone = await client.delete("/api/robots/own_model", headers=robot)
            assert gone.status_code == 204
        records = await service.journal.read_records(0, 100, ev.NO_RUN)
        told = [each.text for each in records if '"model_' in each.text]
        assert ['"role":"robot"' in each for each in told] == [True, True]


async def test_models_are_there_after_a_restart(tmp_path: Path) -> None:
    journal, folder = SqliteJournal(":memory:"), tmp_path / "models"
    model, new = await own_models(folder, journal).keep("lamp", packed(), ANNA, packed=True)
    assert new
    (folder / "broken.model.zip").write_bytes(b"torn")
    (folder / "half.model.zip.new").write_bytes(b"torn")
    again = own_models(folder, journal)
    assert again.all() == [model]
    assert not (folder / "half.model.zip.new").exists()
    assert model.read("robot.urdf").decode() == DESCRIPTION
    [kept] = await journal.read_readable(0, 10, ev.NO_RUN)
    deed = deed_of(kept)
    assert deed is not None
    assert (deed.who, deed.what) == ("anna", "uploaded the robot model 'lamp'")
    journal.close()


async def test_too_much_at_once_is_refused_in_every_language(client: httpx.AsyncClient) -> None:
    large = {**ZIP, "Content-Length": str(MODEL_BODY_BYTES + 1)}
    refused = await client.put("/api/models/lamp", content=b"", headers=large)
    assert (refused.status_code, refused.json()["detail"]) == (
        413, "the body is larger than 32 MiB",
    )  # fmt: skip
    assert untold([refused.json()["detail"], TOO_MANY_BODIES], ["refusals"]) == []


@pytest.mark.parametrize("name", [".", "..", "left/arm"])
async def test_a_name_is_one_part_of_an_address(tmp_path: Path, name: str) -> None:
    journal = SqliteJournal(":memory:")
    models = own_models(tmp_path / "models", journal)
    with refused_in_every_language(WrongInputError, "one part of an address"):
        await models.keep(name, packed(), ANNA, packed=True)
    journal.close()


async def test_names_of_worlds_models_are_theirs(tmp_path: Path) -> None:
    journal = SqliteJournal(":memory:")
    models = own_models(tmp_path / "models", journal)
    with refused_in_every_language(ConflictError, "'pr2' is that of a world"):
        await models.keep("pr2", packed(), ANNA, packed=True)
    with refused_in_every_language(ConflictError, "'pr2' is that of a world"):
        await models.delete("pr2", ANNA)
    journal.close()


async def test_all_together_have_so_much_room(tmp_path: Path) -> None:
    journal, size = SqliteJournal(":memory:"), len(packed())
    models = own_models(tmp_path / "models", journal, Limits(models_bytes=size + size // 2))
    await models.keep("lamp", packed(), ANNA, packed=True)
    await models.keep("lamp", packed(), ANNA, packed=True)
    with refused_in_every_language(ConflictError, "there is no room for the robot model 'other'"):
        await models.keep("other", packed(), ANNA, packed=True)
    assert [each.name for each in models.all()] == ["lamp"]
    journal.close()


async def test_what_the_journal_cannot_tell_is_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal, folder = SqliteJournal(":memory:"), tmp_path / "models"
    models = own_models(folder, journal)

    async def fail(*_: object, **__: object) -> None:
        raise JournalWriteError("the disk is full")

    monkeypatch.setattr(journal, "append", fail)
    with pytest.raises(JournalWriteError):
        await models.keep("lamp", packed(), ANNA, packed=True)
    assert (models.all(), list(folder.iterdir())) == ([], [])
    journal.close()


async def test_of_two_at_once_the_later_one_is_kept(tmp_path: Path) -> None:
    journal = SqliteJournal(":memory:")
    models = own_models(tmp_path / "models", journal)
    kept = await asyncio.gather(
        models.keep("lamp", packed(), ANNA, packed=True),
        models.keep("lamp", BARE.encode(), ANNA, packed=False),
    )
    assert sorted(new for _, new in kept) == [False, True]
    [model] = models.all()
    assert model.read("robot.urdf")
    journal.close()


async def test_a_journal_in_memory_keeps_no_models() -> None:
    service = build(journal=":memory:")
    async with service.client() as client:
        refused = await client.put("/api/models/lamp", content=packed(), headers=ZIP)
    assert refused.status_code == 409
    assert "journal in memory" in refused.json()["detail"]
    service.journal.close()


async def test_what_the_disk_does_not_take_or_give_up_is_told_in_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = SqliteJournal(":memory:")
    (tmp_path / "file").write_text("no folder")
    with refused_in_every_language(UnavailableError, "the robot model 'lamp' cannot be kept: "):
        await own_models(tmp_path / "file", journal).keep("lamp", packed(), ANNA, packed=True)
    models = own_models(tmp_path / "models", journal)
    model, _ = await models.keep("lamp", packed(), ANNA, packed=True)

    def fail(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "unlink", fail)
    with refused_in_every_language(UnavailableError, "cannot be deleted: Permission denied"):
        await models.delete("lamp", ANNA)
    assert models.all() == [model]
    journal.close()


async def test_a_model_whose_file_is_gone_is_told_in_a_sentence(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    kept = (await client.put("/api/models/lamp", content=packed(), headers=ZIP)).json()
    folder = service.settings.models_path
    assert folder is not None
    (archive,) = folder.iterdir()
    archive.write_bytes(b"torn")
    torn = await client.get(kept["urdf"])
    assert torn.status_code == 500
    assert "upload it again" in torn.json()["detail"]
    archive.unlink()
    assert (await client.get(kept["urdf"])).status_code == 404
    again = await client.put("/api/models/lamp", content=packed(), headers=ZIP)
    assert (again.status_code, again.json()) == (200, kept)

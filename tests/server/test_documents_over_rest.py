"""Scenes, scenarios and task trees over REST: checked, kept, replaced and deleted."""

import contextlib
import json
from collections.abc import AsyncIterator

import httpx
import pytest
from noon import at_noon
from service_under_test import build

from mend.errors import ConflictError
from mend.robots.arm.body import Reach
from mend.server.documents import MOST_MISTAKES, DocumentKind
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.journal.journal import Document, Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.library import Library, build_library
from mend.server.limits import Limits
from mend.server.off_loop import MUCH_CHARS
from mend.server.runtime.requests import RunRequest
from mend.server.scene_checks import WorldChecks
from mend.tasks.library import SCENES
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

SCENE = """\
name: bench
objects:
  cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.08], pose: {x: 0.5, y: -0.3}}
  pot: {color: [0.1, 0.1, 1.0], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.5}}
places:
  tray: {pose: {x: 0.5, y: 0.0}}
"""
TREE = """\
name: serve
scene: bench
tree: {behavior: pick_and_place, object: cup, place: tray}
"""
SCENARIO = """\
name: clumsy
tree: serve
interventions:
  - {when: {object: cup, step: 4}, do: {act: steal, object: cup}}
answers: [yes, no]
"""
YAML = {"content-type": "application/yaml; charset=utf-8"}
EVERY_KIND = pytest.mark.parametrize(
    ("path", "text"), [("scenes", SCENE), ("trees", TREE), ("scenarios", SCENARIO)]
)


class TimidWorld:
    """A world whose robot takes nothing that is higher than 6 cm."""

    own_process = False
    lays_out_anything = False

    def check_available(self) -> None: ...

    def check_scene(self, scene, leaves) -> list[SceneProblem]:
        names = {each.object for each in leaves} or set(scene.objects)
        return [
            SceneProblem(("objects", name, "size"), f"'{name}' is too high")
            for name in sorted(names)
            if scene.objects[name].size[2] > 0.06
        ]


class BoldWorld(TimidWorld):
    def check_scene(self, scene, leaves) -> list[SceneProblem]:  # noqa: ARG002
        return []

    def reach(self, scene: Scene) -> Reach:  # noqa: ARG002
        return Reach((0.1, 0.2), 0.3, 0.8)


class IdleWorld:
    """One that checks nothing."""

    def check_available(self) -> None: ...


def library(**worlds) -> Library:
    checks = WorldChecks(worlds)
    fixed = fixed_documents(GivenFiles(), None)
    return build_library(SqliteJournal(":memory:"), fixed, checks, utc_now=at_noon)


@contextlib.asynccontextmanager
async def client_of(own: Library) -> AsyncIterator[httpx.AsyncClient]:
    service = build()
    parts = service.app.state.services
    object.__setattr__(parts, "trees", own.trees)
    object.__setattr__(parts, "scenes", own.scenes)
    object.__setattr__(parts, "scenarios", own.scenarios)
    async with service.client() as client:
        yield client
    own.off_loop.close()
    own.journal.close()
    service.journal.close()


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    worlds = {"timid": TimidWorld(), "bold": BoldWorld(), "idle": IdleWorld()}
    async with client_of(library(**worlds)) as client:
        yield client


@pytest.fixture
async def worldless() -> AsyncIterator[httpx.AsyncClient]:
    """One whose worlds are known to any process: there are none."""
    async with client_of(library()) as client:
        yield client


def names(response: httpx.Response) -> list[str]:
    return names_of(response.json())


def names_of(listed: list[dict[str, str]]) -> list[str]:
    return [each["name"] for each in listed]


async def keep_all(client: httpx.AsyncClient) -> None:
    for path, text in (("scenes", SCENE), ("trees", TREE), ("scenarios", SCENARIO)):
        response = await client.post(f"/api/{path}", content=text, headers=YAML)
        assert response.status_code == 201, response.text


async def test_a_scene_a_tree_and_a_scenario_are_kept_and_read(client: httpx.AsyncClient) -> None:
    await keep_all(client)
    scene = (await client.get("/api/scenes/bench")).json()
    assert (scene["text"], scene["built_in"]) == (SCENE, False)
    assert scene["definition"]["objects"]["cup"]["size"] == [0.05, 0.05, 0.08]
    tree = (await client.get("/api/trees/serve")).json()
    assert tree["definition"]["nodes"][0]["parameters"]["object"] == "cup"
    scenario = (await client.get("/api/scenarios/clumsy")).json()
    assert scenario["definition"]["answers"] == ["yes", "no"]
    listed = (await client.get("/api/scenes")).json()
    assert {"name": "bench", "built_in": False, "objects": 2, "places": 1} in listed
    listed = (await client.get("/api/scenarios")).json()
    assert {
        "name": "clumsy",
        "built_in": False,
        "tree": "serve",
        "description": "",
        "answers": ["yes", "no"],
    } in listed


@EVERY_KIND
async def test_post_keeps_under_the_name_that_is_given(
    client: httpx.AsyncClient, path: str, text: str
) -> None:
    await keep_all(client)
    before = names(await client.get(f"/api/{path}"))
    first = await client.post(f"/api/{path}", json={"name": "other", "text": text})
    assert (first.status_code, first.json()["name"]) == (201, "other")
    assert first.headers["location"] == f"/api/{path}/other"
    again = await client.post(f"/api/{path}?name=other", content=text, headers=YAML)
    assert (again.status_code, again.json()["name"]) == (200, "other")
    assert names(await client.get(f"/api/{path}")) == sorted([*before, "other"])
    assert (await client.delete(f"/api/{path}/other")).status_code == 204
    assert (await client.delete(f"/api/{path}/other")).status_code == 404
    assert names(await client.get(f"/api/{path}")) == before


@EVERY_KIND
async def test_what_has_no_name_is_refused(client: httpx.AsyncClient, path: str, text: str) -> None:
    nameless = text.partition("\n")[2]
    assert (await client.post(f"/api/{path}", content=nameless, headers=YAML)).status_code == 422


@EVERY_KIND
async def test_put_keeps_under_the_name_of_the_address(
    client: httpx.AsyncClient, path: str, text: str
) -> None:
    await keep_all(client)
    first = await client.put(f"/api/{path}/other", content=text, headers=YAML)
    assert first.status_code == 201
    assert first.headers["location"] == f"/api/{path}/other"
    assert (await client.put(f"/api/{path}/other", json={"text": text})).status_code == 200
    assert (await client.get(f"/api/{path}/other")).json()["definition"]["name"] == "other"
    assert (await client.delete(f"/api/{path}/other")).status_code == 204
    assert (await client.get(f"/api/{path}/other")).status_code == 404


@pytest.mark.parametrize(
    ("path", "name", "text"),
    [
        ("scenes", "eket", SCENE),
        ("scenarios", "eket_paper", SCENARIO.replace("serve", "eket").replace("cup", "pink_bar")),
        ("trees", "eket", TREE),
    ],
)
async def test_what_is_built_in_is_protected(
    client: httpx.AsyncClient, path: str, name: str, text: str
) -> None:
    await keep_all(client)
    for response in (
        await client.put(f"/api/{path}/{name}", content=text, headers=YAML),
        await client.delete(f"/api/{path}/{name}"),
    ):
        assert response.status_code == 409
        assert response.headers["content-type"] == "application/problem+json"
        assert "built in" in response.json()["detail"]


async def test_mistakes_are_told_with_their_lines_and_nothing_is_kept(
    client: httpx.AsyncClient,
) -> None:
    wrong = SCENE.replace("0.08]", "high]")
    refused = await client.post("/api/scenes", content=wrong, headers=YAML)
    assert refused.status_code == 422
    assert refused.json()["errors"] == [
        "line:3: 'objects.cup.size.2' must be a number (in metres), but it is \"high\""
    ]
    assert (await client.get("/api/scenes/bench")).status_code == 404
    checked = (await client.post("/api/scenes/check", json={"text": wrong})).json()
    assert checked["definition"] is None
    assert [(each["line"], each["column"]) for each in checked["errors"]] == [(3, 3)]


async def test_checking_keeps_nothing(client: httpx.AsyncClient) -> None:
    before = names(await client.get("/api/scenes"))
    for checked in (
        await client.post("/api/scenes/check", json={"text": SCENE}),
        await client.post("/api/scenes/check", content=SCENE, headers=YAML),
    ):
        assert checked.status_code == 200
        assert (checked.json()["name"], checked.json()["errors"]) == ("bench", [])
        assert checked.json()["definition"]["objects"].keys() == {"cup", "pot"}
    assert (await client.post("/api/scenes/check", content=SCENE, headers={})).status_code == 415
    assert names(await client.get("/api/scenes")) == before


async def test_what_is_built_in_is_listed_and_read(client: httpx.AsyncClient) -> None:
    listed = (await client.get("/api/scenes")).json()
    assert {"name": "eket", "built_in": True, "objects": 6, "places": 6} in listed
    scene = (await client.get("/api/scenes/eket")).json()
    assert (scene["name"], scene["built_in"]) == ("eket", True)
    assert scene["definition"]["objects"]["green_leg"]["size"] == [0.03, 0.2, 0.08]
    assert scene["text"] == SCENES.read("eket")
    assert (await client.get("/api/scenes/..%2Feket")).status_code in (404, 422)


async def test_a_scenario_for_what_is_not_there_is_refused(client: httpx.AsyncClient) -> None:
    refused = await client.post("/api/scenarios", content=SCENARIO, headers=YAML)
    assert refused.status_code == 422
    assert "there is no task tree 'serve'" in refused.json()["errors"][0]
    await keep_all(client)
    unknown = SCENARIO.replace("object: cup}}", "object: mug}}").replace("clumsy", "mugs")
    refused = await client.post("/api/scenarios", content=unknown, headers=YAML)
    assert "the object 'mug', which the scene 'bench' has not" in refused.json()["errors"][0]
    late = SCENARIO.replace("step: 4", "step: 12").replace("clumsy", "late")
    refused = await client.post("/api/scenarios", content=late, headers=YAML)
    assert refused.status_code == 422
    assert "names step 12 for 'cup'" in refused.json()["errors"][0]


async def test_a_scene_is_told_how_far_its_robots_reach(client: httpx.AsyncClient) -> None:
    robots = "robots:\n  near: {x: 0.0, y: 0.0}\n  far: {x: 1.0, y: 0.5, yaw: 3.14159}\n"
    checked = (await client.post("/api/scenes/check", json={"text": SCENE + robots})).json()
    reach = {each["world"]: each["reach"] for each in checked["worlds"]}
    assert reach["timid"] == []
    near, far = reach["bold"]
    assert near == {"robot": "near", "x": 0.1, "y": 0.2, "min_m": 0.3, "max_m": 0.8}
    assert (far["robot"], far["x"], far["y"]) == ("far", pytest.approx(0.9), pytest.approx(0.3))


async def test_what_no_world_can_do_is_a_mistake_and_the_worlds_are_told() -> None:
    async with client_of(library(timid=TimidWorld())) as client:
        checked = (await client.post("/api/scenes/check", json={"text": SCENE})).json()
    (mistake,) = checked["errors"]
    (fit,) = checked["worlds"]
    assert mistake["message"] == "in the world 'timid': 'cup' is too high"
    assert (fit["world"], fit["problems"][0]["message"]) == ("timid", "'cup' is too high")


async def test_behaviors_are_listed_with_their_parameters(client: httpx.AsyncClient) -> None:
    listed = (await client.get("/api/behaviors")).json()
    assert names_of(listed) == sorted(names_of(listed))
    (place,) = [each["parameters"] for each in listed if each["name"] == "pick_and_place"]
    assert place["required"] == ["object", "place"]
    assert place["properties"]["needs_help"]["default"] is False


async def test_what_only_some_worlds_can_do_is_kept_and_said(client: httpx.AsyncClient) -> None:
    kept = (await client.post("/api/scenes", content=SCENE, headers=YAML)).json()
    fits = {each["world"]: each["problems"] for each in kept["worlds"]}
    assert fits.keys() == {"timid", "bold"}
    assert fits["bold"] == []
    assert [(each["line"], each["message"]) for each in fits["timid"]] == [(3, "'cup' is too high")]
    tree = (await client.post("/api/trees/check", json={"text": TREE})).json()
    (problem,) = {each["world"]: each["problems"] for each in tree["worlds"]}["timid"]
    assert (problem["node"], problem["message"]) == ("/", "'cup' is too high")
    at = next(n for n, line in enumerate(TREE.splitlines(), 1) if "behavior:" in line)
    assert problem["line"] == at


async def test_what_no_world_can_do_is_refused() -> None:
    checked = (await library(timid=TimidWorld()).scenes.check(SCENE)).view()
    assert [each.message for each in checked.errors] == ["in the world 'timid': 'cup' is too high"]
    low = SCENE.replace("0.08]", "0.05]")
    assert (await library(timid=TimidWorld()).scenes.check(low)).view().errors == []


async def test_a_scene_that_a_tree_needs_is_neither_deleted_nor_spoilt(
    client: httpx.AsyncClient,
) -> None:
    await keep_all(client)
    without_cup = SCENE.replace("  cup:", "  mug:")
    for response in (
        await client.delete("/api/scenes/bench"),
        await client.put("/api/scenes/bench", content=without_cup, headers=YAML),
        await client.delete("/api/trees/serve"),
    ):
        assert response.status_code == 409
        assert "change or delete it first" in response.json()["detail"]
    changed = SCENE.replace("0.08]", "0.06]")
    assert (await client.put("/api/scenes/bench", content=changed, headers=YAML)).is_success
    for path in ("scenarios/clumsy", "trees/serve", "scenes/bench"):
        assert (await client.delete(f"/api/{path}")).status_code == 204


@pytest.mark.parametrize("path", ["scenes", "trees", "scenarios"])
@pytest.mark.parametrize(
    ("content", "kind", "status"),
    [
        (b'{"text": 7}', "application/json", 422),
        (b'{"text": "", "more": 1}', "application/json", 422),
        (b'{"text": "\\ud800then"}', "application/json", 422),
        (b'{"name": "../etc", "text": "then: []"}', "application/json", 422),
        (b"\xff", "application/yaml", 400),
        (b"name: x", "text/plain", 415),
        (b"name: x", "", 415),
        (b"{", "application/json", 422),
        (b"", "application/yaml", 422),
        (b"nothing", "application/yaml", 422),
    ],
)
async def test_hostile_uploads_are_refused_and_nothing_is_kept(
    client: httpx.AsyncClient, path: str, content: bytes, kind: str, status: int
) -> None:
    before = names(await client.get(f"/api/{path}"))
    response = await client.post(f"/api/{path}", content=content, headers={"content-type": kind})
    assert response.status_code == status
    assert response.headers["content-type"] == "application/problem+json"
    assert names(await client.get(f"/api/{path}")) == before


async def test_a_tree_is_loaded_with_its_scene_or_another_one_that_it_fits() -> None:
    own = library()
    await own.scenes.save(None, SCENE)
    await own.trees.save(None, TREE)
    await own.scenes.save("high", SCENE.replace("0.08]", "0.11]"))
    await own.scenes.save("bare", SCENE.replace("  cup:", "  mug:"))
    loaded = await own.prepare(of_serve())
    assert loaded.scene.name == "bench"
    other = await own.prepare(of_serve(scene="high"))
    assert (other.scene.name, other.scene.objects["cup"].size[2]) == ("high", 0.11)
    assert json.loads(other.tree)["scene"] == "high"
    with pytest.raises(Exception, match="cannot be used"):
        await own.prepare(of_serve(scene="bare"))
    with pytest.raises(Exception, match="there is no scene 'nowhere'"):
        await own.prepare(of_serve(scene="nowhere"))


def of_serve(**fields: str) -> RunRequest:
    return RunRequest.model_validate({"tree": "serve", "world": "live", **fields})


async def test_documents_of_two_kinds_may_have_one_name() -> None:
    journal = SqliteJournal(":memory:")
    for kind, text in ((DocumentKind.SCENE, "a scene"), (DocumentKind.TREE, "a tree")):
        await journal.append(Entry(document=Document(kind, "x", text)))
    assert await journal.documents("scene") == {"x": "a scene"}
    await journal.append(Entry(document=Document(DocumentKind.TREE, "x", None)))
    assert await journal.documents("scene") == {"x": "a scene"}
    assert await journal.documents("tree") == {}
    journal.close()


async def test_all_that_is_uploaded_of_one_kind_has_a_limit() -> None:
    checks, fixed = WorldChecks({}), fixed_documents(GivenFiles(), None)
    journal = SqliteJournal(":memory:")
    limits = Limits(uploaded_chars=len(SCENE) + 10)
    scenes = build_library(journal, fixed, checks, limits, utc_now=at_noon).scenes
    await scenes.save("bench", SCENE)
    with pytest.raises(ConflictError, match="no room for the scene 'other'"):
        await scenes.save("other", SCENE)
    assert not (await scenes.save("bench", SCENE + "# kept")).new
    assert (await scenes.get("bench")).view().text.endswith("# kept")
    await scenes.delete("bench")
    await scenes.save("other", SCENE)
    journal.close()


def large_tree(leaves: int, behavior: str = "pick_and_place") -> str:
    line = f"  - {{behavior: {behavior}, object: red_box, place: tray}}\n"
    return "name: large\ntree:\n  or:\n" + line * leaves


async def test_a_large_tree_is_checked_kept_and_given_out_as_a_small_one(
    worldless: httpx.AsyncClient,
) -> None:
    text = large_tree(3000)
    assert len(text) > MUCH_CHARS
    yaml = {"content-type": "application/yaml"}
    checked = await worldless.post("/api/trees/check", content=text, headers=yaml)
    assert (checked.status_code, checked.json()["errors"]) == (200, [])
    kept = await worldless.post("/api/trees", content=text, headers=yaml)
    assert (kept.status_code, kept.headers["location"]) == (201, "/api/trees/large")
    found = (await worldless.get("/api/trees/large")).json()
    assert found["text"] == text
    assert len(found["definition"]["nodes"]) == 3001
    assert found["definition"] == checked.json()["definition"] == kept.json()["definition"]


async def test_of_very_many_mistakes_the_first_are_told(worldless: httpx.AsyncClient) -> None:
    text = large_tree(3000, behavior="fly")
    refused = await worldless.post(
        "/api/trees", content=text, headers={"content-type": "application/yaml"}
    )
    assert refused.status_code == 422
    problem = refused.json()
    assert problem["detail"] == "the task file has 3000 mistakes"
    assert len(problem["errors"]) == MOST_MISTAKES + 1
    assert problem["errors"][-1] == "there are 2000 more mistakes"

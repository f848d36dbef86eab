"""A head picture is understood once, and anew if anything changed or what it shows is doubted."""

import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene
from scripted_body import STARTS, ScriptedBody, catalogue, trained_model

import mend.robots.arm.perception.table_understanding
from mend.robots.arm.perception import Perception
from mend.robots.body import CameraImage
from mend.robots.vision.table_view import TableView, view_table


@pytest.fixture
def understood(monkeypatch: pytest.MonkeyPatch) -> list[CameraImage]:
    """The pictures that were understood."""
    pictures = []

    def view(image: CameraImage, *rest: object) -> TableView | None:
        pictures.append(image)
        return view_table(image, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(mend.robots.arm.perception.table_understanding, "view_table", view)
    return pictures


def picture(seed: int) -> CameraImage:
    scene = DrawnScene({name: each.matrix() for name, each in STARTS.items()}, noise=2.0, seed=seed)
    return scene.picture()


def test_noise_alone_is_no_reason_to_understand_a_picture_anew(
    understood: list[CameraImage],
) -> None:
    perception = Perception(ScriptedBody(STARTS), trained_model(), catalogue())
    for seed in range(3):
        assert perception.head.sight(PARTS["pink_bar"], picture(seed)) is not None
    assert len(understood) == 1


def test_what_is_doubted_is_understood_anew_once(understood: list[CameraImage]) -> None:
    perception = Perception(ScriptedBody(STARTS), trained_model(), catalogue())
    perception.head.sight(PARTS["pink_bar"], picture(0))
    perception.head.doubt()
    for seed in (1, 2):
        perception.head.sight(PARTS["pink_bar"], picture(seed))
    assert len(understood) == 2


def test_the_very_same_picture_shows_the_same_however_much_it_is_doubted(
    understood: list[CameraImage],
) -> None:
    perception = Perception(ScriptedBody(STARTS), trained_model(), catalogue())
    for _ in range(2):
        perception.head.sight(PARTS["pink_bar"], picture(0))
        perception.head.doubt()
    assert len(understood) == 1


BEFORE_PINK = [((0.36, -0.25, TABLE_Z), (0.05, 0.2, 0.2))]
"""Something tall between the camera and the pink bar."""


def names_seen(perception: Perception, *, without: str = "", hidden: bool) -> set[str | None]:
    parts = {name: each.matrix() for name, each in STARTS.items() if name != without}
    image = DrawnScene(parts, grey_boxes=BEFORE_PINK if hidden else []).picture()
    return {box.name for box in perception.head.seen_boxes(image)}


def test_what_is_hidden_is_taken_to_stand_where_it_was_seen() -> None:
    perception = Perception(ScriptedBody(STARTS), trained_model(), catalogue())
    assert names_seen(perception, hidden=True) == (set(STARTS) - {"pink_bar"}) | {None}
    assert names_seen(perception, hidden=False) == set(STARTS)
    assert names_seen(perception, hidden=True) == set(STARTS) | {None}


def test_what_is_seen_gone_is_not_recalled_any_more() -> None:
    perception = Perception(ScriptedBody(STARTS), trained_model(), catalogue())
    names_seen(perception, hidden=False)
    assert "pink_bar" not in names_seen(perception, without="pink_bar", hidden=False)
    assert "pink_bar" not in names_seen(perception, without="pink_bar", hidden=True)

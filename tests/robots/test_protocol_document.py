"""docs/robot_protocol.md says what the models say."""

import json
import re
from pathlib import Path
from typing import get_args

import pytest
from pydantic import BaseModel

from mend.robots.link import messages as m
from mend.tasks.intervention import Intervention

DOCUMENT = Path(__file__).parents[2] / "docs" / "robot_protocol.md"


def members(union: object) -> list[type[BaseModel]]:
    return list(get_args(get_args(union)[0]))


PARTS: dict[str, type[BaseModel]] = {
    "reach": m.ReachLimits,
    "base": m.BaseLimits,
    "executing": m.ActiveExecution,
    "driven": m.Driven,
    "detection": m.Detection,
    "finished_result": m.FinishedResult,
    "sighting": m.Sighting,
    "room": m.RoomLimits,
    "swing": m.SwingLimits,
    "clip_picture": m.ClipPicture,
    "shows": m.PoseLayout,
    "shown": m.ShownObject,
    "shown_pose": m.ShownPose,
    "position": m.Position,
    "location": m.Location,
    "closed_way": m.ClosedWay,
    "failed_robot": m.FailedRobot,
    "way_point": m.WayPoint,
    "intervention": Intervention,
}
MODELS = PARTS | {
    model.model_fields["type"].default: model
    for union in (m.RobotMessage, m.ServiceMessage, m.ReportBody, m.CommandBody)
    for model in members(union)
}


def sections() -> dict[str, str]:
    """What stands under each heading that is the name of a message or of a part of one."""
    found = re.split(r"^### `(\w+)`$", DOCUMENT.read_text(), flags=re.MULTILINE)
    bodies = [re.split(r"^## ", each, flags=re.MULTILINE)[0] for each in found[2::2]]
    return dict(zip(found[1::2], bodies, strict=True))


def table_rows(text: str) -> dict[str, str]:
    """The first table's fields, and how each is described."""
    table = text.split("| field |")[1].split("\n\n")[0]
    return dict(re.findall(r"^\| `(\w+)` \| (.*) \|", table, flags=re.MULTILINE))


def test_every_message_has_its_section_and_no_other_has() -> None:
    assert sections().keys() == MODELS.keys()


@pytest.mark.parametrize("name", sorted(MODELS))
def test_the_fields_of_a_message_are_those_of_its_model(name: str) -> None:
    rows = table_rows(sections()[name])
    fields = MODELS[name].model_fields
    assert list(rows) == list(fields)
    for field, described in rows.items():
        optional = "default" in described.split("|")[0]
        expected = not fields[field].is_required() and field != "type"
        assert optional == expected, f"{name}.{field}"


@pytest.mark.parametrize("name", sorted(MODELS))
def test_the_values_that_a_field_may_have_are_all_named(name: str) -> None:
    section = sections()[name]
    for field, info in MODELS[name].model_fields.items():
        annotations = [info.annotation, *get_args(info.annotation)]
        for choice in (
            value for each in annotations for value in get_args(each) if isinstance(value, str)
        ):
            assert f"`{choice}`" in section or f'`"{choice}"`' in section, f"{name}.{field}"


def test_every_example_is_a_message() -> None:
    examples = re.findall(r"```json\n(.*?)```", DOCUMENT.read_text(), flags=re.DOTALL)
    assert len(examples) >= 5
    robot = {model.model_fields["type"].default for model in members(m.RobotMessage)}
    for example in examples:
        from_robot = json.loads(example)["type"] in robot
        (m.robot_message if from_robot else m.service_message).validate_json(example)


def test_the_version_is_the_one_in_the_title() -> None:
    assert DOCUMENT.read_text().startswith(f"# The robot protocol, version {m.PROTOCOL_VERSION}\n")

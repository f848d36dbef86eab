"""JSON Schemas of task, scene and scenario files, for editors and other tools."""

from typing import Any

from pydantic import BaseModel, TypeAdapter

from mend.tasks.flat_form import IGNORED_KEYS
from mend.tasks.leaf_check import Behaviors
from mend.tasks.nested_form import DECLARED_AUTONOMY, GOAL_KEYS
from mend.tasks.part_rows import Grid
from mend.tasks.scenario import Scenario
from mend.tasks.scene import Name, Scene

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def scene_schema() -> dict[str, Any]:
    """The JSON Schema of a scene file."""
    schema = Scene.model_json_schema()
    definitions = schema["$defs"]
    grid = Grid.model_json_schema(ref_template="#/$defs/{model}")
    definitions |= {**grid.pop("$defs", {}), "Grid": grid}
    for kind in ("SceneObject", "Place"):
        _take_several_poses(definitions[kind])
    return {"$schema": _DIALECT, **schema}


def _take_several_poses(entry: dict[str, Any]) -> None:
    """An entry of a scene has one of `pose`, `poses` and `grid`."""
    poses = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/Pose"}}
    entry["properties"] |= {"poses": poses, "grid": {"$ref": "#/$defs/Grid"}}
    entry["required"] = [key for key in entry["required"] if key != "pose"]
    entry["oneOf"] = [{"required": [key]} for key in ("pose", "poses", "grid")]


def scenario_schema() -> dict[str, Any]:
    """The JSON Schema of a scenario file."""
    return {"$schema": _DIALECT, **Scenario.model_json_schema()}


def task_schema(behaviors: Behaviors) -> dict[str, Any]:
    """The JSON Schema of a task file, in the nested or the flat form, with these behaviors."""
    name = TypeAdapter(Name).json_schema()
    definitions: dict[str, Any] = {"name": name}
    for key in GOAL_KEYS:
        definitions[key] = _goal_schema(key)
    for behavior, model in behaviors.items():
        definitions[f"behavior.{behavior}"] = _leaf_schema(behavior, model, definitions)
    kinds = [*GOAL_KEYS, *(f"behavior.{behavior}" for behavior in behaviors)]
    definitions["node"] = {"oneOf": [{"$ref": f"#/$defs/{kind}"} for kind in kinds]}
    definitions["flat_node"] = _flat_node_schema()
    return {
        "$schema": _DIALECT,
        "title": "Task file",
        "oneOf": [_nested_schema(), _flat_schema()],
        "$defs": definitions,
    }


def _head() -> dict[str, Any]:
    name = {"$ref": "#/$defs/name"}
    return {"name": name, "description": {"type": "string"}, "scene": name}


def _object(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": False,
    }


def _nested_schema() -> dict[str, Any]:
    return _object(_head() | {"tree": {"$ref": "#/$defs/node"}}, ["name", "tree"])


def _goal_schema(key: str) -> dict[str, Any]:
    children = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/node"}}
    return _object({"name": {"$ref": "#/$defs/name"}, key: children}, [key])


def _leaf_schema(
    behavior: str, model: type[BaseModel], definitions: dict[str, Any]
) -> dict[str, Any]:
    """A leaf of one behavior; what its parameters refer to is added to the definitions."""
    parameters = model.model_json_schema(ref_template="#/$defs/{model}")
    definitions.update(parameters.pop("$defs", {}))
    properties = {
        "name": {"$ref": "#/$defs/name"},
        "behavior": {"const": behavior},
        "autonomy": {"enum": list(DECLARED_AUTONOMY)},
        **parameters.get("properties", {}),
    }
    return _object(properties, ["behavior", *parameters.get("required", [])])


def _flat_schema() -> dict[str, Any]:
    names = {"type": "array", "items": {"$ref": "#/$defs/name"}}
    nodes = {"type": "object", "additionalProperties": {"$ref": "#/$defs/flat_node"}}
    return _object(_head() | {"NodeList": names, "Nodes": nodes}, ["NodeList", "Nodes"])


def _flat_node_schema() -> dict[str, Any]:
    count = {"type": "integer", "minimum": 0}
    mask = _object(
        {"type": count | {"maximum": 7}, "robot": count, "node": count, "skill": {}},
        ["type", "robot", "node"],
    )
    names = {"type": ["array", "null"], "items": {"type": "string"}}
    properties: dict[str, Any] = {
        "mask": mask,
        "parent": {"type": "string"},
        "children": names,
        "peers": names,
        "object": {"type": "string"},
        "place": {"type": "string"},
        "needs_help": {"type": "boolean"},
    }
    properties |= {key: {} for key in IGNORED_KEYS}
    return _object(properties, ["mask", "parent"])

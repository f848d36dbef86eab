"""What worlds found of the scenes that they checked last.

Who writes a task has it checked while writing, on keeping it and at the start of each run: the same
scene and leaves again and again, of which the check takes up to seconds.
"""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

_MOST_REMEMBERED = 64
"""Some kilobytes each: the scene and its text."""


def checked_scene(
    maker: tuple[str, str], scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
) -> list[SceneProblem]:
    """What keeps all robots of the world that an object of a module makes from doing the leaves
    among `nodes` in a scene.
    """
    text = "\n".join(each.model_dump_json() for each in (scene, *nodes))
    return list(_found(_Asked(maker, text, scene, nodes)))


def made_by(maker: tuple[str, str]) -> Any:
    """The object of that name in a module, which is loaded now."""
    module, name = maker
    return getattr(importlib.import_module(module), name)


@dataclass(frozen=True, slots=True)
class _Asked:
    """The same where it reads the same."""

    maker: tuple[str, str]
    text: str
    scene: Scene = field(compare=False)
    nodes: Sequence[GoalNode | BehaviorNode] = field(compare=False)


@lru_cache(_MOST_REMEMBERED)
def _found(asked: _Asked) -> Sequence[SceneProblem]:
    return tuple(made_by(asked.maker).check_scene(asked.scene, asked.nodes))

"""Which robot stands where in the scene of a `live` run."""

from collections.abc import Iterable, Mapping, Sequence

from mend.errors import WrongInputError
from mend.tasks.scene import Scene


def stand(robots: Sequence[str] | Mapping[str, str], scene: Scene) -> tuple[list[str], Scene]:
    """The robots in the order in which the scene says where they stand, and that scene.

    `robots`: connected ones by their places in the scene, of which others then stay empty; or a
    list for all its places, in which who is called as a place is stands there. A scene that does
    not say where robots stand is in the frame of each. Raises `WrongInputError`.
    """
    names = list(robots.values() if isinstance(robots, Mapping) else robots)
    twice = next((each for each in names if names.count(each) > 1), None)
    if twice is not None:
        raise WrongInputError(f"'robots' names the robot '{twice}' more than once; once is enough")
    placed = robots if isinstance(robots, Mapping) else _in_turn(names, scene)
    unknown = next((each for each in placed if each not in scene.robots), None)
    if unknown is not None:
        there = (
            f"it has {_quoted(scene.robots)}"
            if scene.robots
            else "it does not say where robots stand"
        )
        raise WrongInputError(
            f"'robots': the scene '{scene.name}' has no robot '{unknown[:64]}'; {there}"
        )
    if not placed:
        return names, scene
    bases = {place: base for place, base in scene.robots.items() if place in placed}
    return [placed[place] for place in bases], scene.model_copy(update={"robots": bases})


def _in_turn(names: list[str], scene: Scene) -> Mapping[str, str]:
    """Robots of a list by the places of the scene; nothing where there is nothing to choose."""
    if not (names and scene.robots):
        return {}
    if len(names) != len(scene.robots):
        raise WrongInputError(
            f"'robots' lists {len(names)}, but in the scene '{scene.name}' stand "
            f"{_quoted(scene.robots)}: say which of these each of them is"
        )
    others = iter([each for each in names if each not in scene.robots])
    return {place: place if place in names else next(others) for place in scene.robots}


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f"'{each}'" for each in names)

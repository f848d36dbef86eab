"""One thing about a scene that cannot work, found before anything moves."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SceneProblem:
    """What is wrong and where: `where` are the keys to it in the scene's document.

    `message` is one sentence that says what is wrong and what would be right.
    """

    where: tuple[str, ...]
    message: str

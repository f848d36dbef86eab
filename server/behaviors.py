"""The behaviors that are installed, as the readers of task files need them."""

from pydantic import BaseModel

from mend.tasks.plugins import load_plugins


def behavior_parameters() -> dict[str, type[BaseModel]]:
    """The parameter model of every behavior, by name."""
    return {name: each.parameters for name, each in load_plugins("mend.behaviors").items()}


def behavior_step_counts() -> dict[str, int | None]:
    """How many steps every behavior has, by name; None where that depends."""
    return {name: each.step_count for name, each in load_plugins("mend.behaviors").items()}

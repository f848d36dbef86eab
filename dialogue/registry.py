"""Every dialogue script by the kind of issue it is for, found through `mend.dialogues`."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from mend.dialogue.script import Script, ScriptWithParameters
from mend.dialogue.soundness import UnsoundScriptError, check_script
from mend.tasks.plugins import PluginError, load_plugins

GROUP = "mend.dialogues"


def load_scripts(
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
) -> dict[str, Script]:
    """Load and check every script; `parameters` adjusts some of them by name.

    Raises `PluginError` when a script is unsound or a parameter does not fit, or is for a script
    that there is not.
    """
    given = dict(parameters or {})
    scripts = {
        kind: make_script(kind, provided, given.pop(kind, {}))
        for kind, provided in load_plugins(GROUP).items()
    }
    for kind in given:
        raise PluginError(
            f"there is no dialogue script '{kind}' to adjust; there are {', '.join(scripts)}"
        )
    return scripts


def make_script(kind: str, provided: object, parameters: Mapping[str, Any]) -> Script:
    """The checked script of one entry point. Raises `PluginError` as `load_scripts` does."""
    match provided:
        case Script() if parameters:
            raise PluginError(f"the dialogue script '{kind}' has no parameters to adjust")
        case Script():
            script = provided
        case ScriptWithParameters():
            script = provided.make(_checked(kind, provided, parameters))
        case _:
            raise PluginError(
                f"'{kind}' in '{GROUP}' is a {type(provided).__name__}; it has to be a Script "
                "or a ScriptWithParameters"
            )
    try:
        check_script(kind, script)
    except UnsoundScriptError as error:
        raise PluginError(str(error)) from error
    return script


def _checked(kind: str, provided: ScriptWithParameters[Any], parameters: Mapping[str, Any]) -> Any:
    try:
        return provided.parameters.model_validate(dict(parameters))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise PluginError(
            f"parameter '{where}' of the dialogue script '{kind}' is wrong: {first['msg']}"
        ) from error

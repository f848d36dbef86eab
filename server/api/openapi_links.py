"""Links in the OpenAPI: what can be asked next, with what an answer says.

Clients that explore the API find by them the way from an upload to a run, and to its end.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

RUN_WORLD = "tabletop"
"""The world of runs that a link starts: it runs wherever Mend does."""


@dataclass(frozen=True, slots=True)
class Link:
    """From an answer to another operation, whose parameters and body it fills."""

    operation: str
    parameters: Mapping[str, str]
    body: Any = None

    def described(self) -> dict[str, Any]:
        """As the OpenAPI has it."""
        link = {"operationId": self.operation, "parameters": dict(self.parameters)}
        return link if self.body is None else {**link, "requestBody": self.body}


def _all(operations: Sequence[str], **parameters: str) -> tuple[Link, ...]:
    return tuple(Link(each, parameters) for each in operations)


OF_RUN = (
    "get_run", "pause_run", "resume_run", "abort_run", "intervene", "list_events", "get_layout",
    "get_poses",
)  # fmt: skip
RUN_AGAIN = {"run": "$request.path.run"}
DIALOGUE_AGAIN = {"dialogue": "$request.path.dialogue"}
QUESTION = {"prompt": "$response.body#/prompt/prompt", "helper": "anna"}
OF_DIALOGUE = (
    Link("answer_prompt", DIALOGUE_AGAIN, {**QUESTION, "answer": "yes"}),
    Link("choose_way", DIALOGUE_AGAIN, {**QUESTION, "way": "$response.body#/prompt/ways/0/way"}),
    Link("extend_deadline", DIALOGUE_AGAIN, QUESTION),
    Link("claim_dialogue", DIALOGUE_AGAIN, {"helper": "anna"}),
    Link("say_help_is_done", DIALOGUE_AGAIN, {"helper": "anna"}),
    Link("take_back_promise", DIALOGUE_AGAIN, {"helper": "anna"}),
    Link("release_dialogue", DIALOGUE_AGAIN, {"helper": "anna"}),
    Link("get_picture", {"picture": "$response.body#/picture"}),
    Link("get_prompt_speech", {**DIALOGUE_AGAIN, "prompt": QUESTION["prompt"]}),
    Link("get_prompt_help_speech", {**DIALOGUE_AGAIN, "prompt": QUESTION["prompt"]}),
    Link(
        "get_prompt_effect_speech",
        {**DIALOGUE_AGAIN, "prompt": QUESTION["prompt"], "answer": "yes"},
    ),
)


def _run_of(tree: str) -> dict[str, str]:
    return {"tree": tree, "world": RUN_WORLD, "speed": "max"}


def _of_documents(kind: str) -> dict[tuple[str, str], tuple[Link, ...]]:
    known = _all([f"get_{kind}", f"put_{kind}", f"delete_{kind}"], name="$response.body#/name")
    if kind == "tree":
        known += (Link("start_run", {}, _run_of("$response.body#/name")),)
    first = _all([f"get_{kind}", f"delete_{kind}"], name="$response.body#/0/name")
    if kind == "tree":
        first += (Link("start_run", {}, _run_of("$response.body#/0/name")),)
    return {
        (f"list_{kind}s", "200"): first,
        (f"get_{kind}", "200"): _all([f"delete_{kind}"], name="$response.body#/name"),
        **{
            (f"{do}_{kind}", status): known for do in ("upload", "put") for status in ("200", "201")
        },
    }


LINKS: dict[tuple[str, str], tuple[Link, ...]] = {
    ("sign_in", "204"): _all(["get_session", "sign_out"]),
    ("add_principal", "201"): (
        *_all(["rotate_principal", "revoke_principal"], name="$response.body#/name"),
        Link("sign_in", {}, {"token": "$response.body#/token"}),
    ),
    ("rotate_principal", "200"): _all(["revoke_principal"], name="$request.path.name"),
    ("open_enrolment", "201"): (
        Link("enrol_robot", {}, {"robot": "$response.body#/robot", "code": "$response.body#/code"}),
    ),
    ("enrol_robot", "201"): _all(["revoke_principal"], name="$response.body#/robot"),
    **_of_documents("tree"),
    **_of_documents("scene"),
    **_of_documents("scenario"),
    ("start_run", "201"): (
        *_all(OF_RUN, run="$response.body#/id"),
        Link("get_camera_picture", {"run": "$response.body#/id", "camera": "head"}),
    ),
    ("list_runs", "200"): (
        *_all(OF_RUN, run="$response.body#/0/id"),
        Link("list_runs", {"before": "$response.body#/0/id"}),
    ),
    ("get_run", "200"): (
        Link("get_dialogue", {"dialogue": "$response.body#/dialogues/0/dialogue"}),
        *(Link(each, RUN_AGAIN) for each in OF_RUN[1:]),
    ),
    ("pause_run", "200"): (Link("resume_run", RUN_AGAIN), Link("abort_run", RUN_AGAIN)),
    ("resume_run", "200"): (Link("pause_run", RUN_AGAIN), Link("abort_run", RUN_AGAIN)),
    ("abort_run", "200"): (Link("get_run", RUN_AGAIN), Link("list_events", RUN_AGAIN)),
    ("abort_run", "202"): (Link("get_run", RUN_AGAIN), Link("list_events", RUN_AGAIN)),
    ("intervene", "201"): (Link("get_run", RUN_AGAIN), Link("list_events", RUN_AGAIN)),
    ("list_dialogues", "200"): _all(["get_dialogue"], dialogue="$response.body#/0/dialogue"),
    ("get_dialogue", "200"): OF_DIALOGUE,
    ("claim_dialogue", "200"): OF_DIALOGUE,
    ("release_dialogue", "200"): OF_DIALOGUE,
    ("answer_prompt", "201"): (Link("get_dialogue", DIALOGUE_AGAIN),),
    ("choose_way", "201"): (Link("get_dialogue", DIALOGUE_AGAIN),),
    ("extend_deadline", "200"): (Link("get_dialogue", DIALOGUE_AGAIN),),
    ("say_help_is_done", "200"): (Link("get_dialogue", DIALOGUE_AGAIN),),
    ("take_back_promise", "200"): (Link("get_dialogue", DIALOGUE_AGAIN),),
}
"""By the operation and the status of its answer."""


def add_links(schema: dict[str, Any]) -> None:
    """Add the links to an OpenAPI."""
    operations = {
        operation["operationId"]: operation
        for path in schema["paths"].values()
        for operation in path.values()
    }
    for (operation, status), links in LINKS.items():
        described = {each.operation: each.described() for each in links}
        operations[operation]["responses"][status]["links"] = described

"""What each role may do: one row per endpoint, and one per message of each WebSocket.

A test walks over everything that the service offers and fails for what has no row here.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from starlette.routing import compile_path

from mend.server.access.roles import Role

OPEN = None
"""Whoever reaches the service may do it."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One operation of the REST API, and the role that it needs."""

    operation: str
    method: str
    path: str
    role: Role | None


def _documents(kind: str) -> tuple[Endpoint, ...]:
    path = f"/api/{kind}s"
    return (
        Endpoint(f"list_{kind}s", "GET", path, Role.VIEWER),
        Endpoint(f"get_{kind}", "GET", path + "/{name}", Role.VIEWER),
        Endpoint(f"check_{kind}", "POST", path + "/check", Role.OPERATOR),
        Endpoint(f"upload_{kind}", "POST", path, Role.OPERATOR),
        Endpoint(f"put_{kind}", "PUT", path + "/{name}", Role.OPERATOR),
        Endpoint(f"delete_{kind}", "DELETE", path + "/{name}", Role.OPERATOR),
    )


_RUN = "/api/runs/{run}"
_SITE = "/api/sites/{site}"
_FLEET_ROBOT = _SITE + "/fleet/robots/{robot}"
_REQUEST = "/api/requests/{name:path}"
_DIALOGUE = "/api/dialogues/{dialogue}"
_SPEECH = _DIALOGUE + "/prompts/{prompt}/speech"
_DEVICES = "/api/push/subscriptions"
_PRINCIPAL = "/api/access/principals/{name}"

ENDPOINTS: tuple[Endpoint, ...] = (
    Endpoint("get_session", "GET", "/api/session", OPEN),
    Endpoint("sign_in", "POST", "/api/session", OPEN),
    Endpoint("sign_out", "DELETE", "/api/session", OPEN),
    *_documents("tree"),
    *_documents("scene"),
    *_documents("scenario"),
    Endpoint("list_behaviors", "GET", "/api/behaviors", Role.VIEWER),
    Endpoint("list_worlds", "GET", "/api/worlds", Role.VIEWER),
    Endpoint("list_sites", "GET", "/api/sites", Role.VIEWER),
    Endpoint("get_site", "GET", _SITE, Role.VIEWER),
    Endpoint("list_site_events", "GET", _SITE + "/events", Role.VIEWER),
    Endpoint("open_site", "POST", "/api/sites", Role.OPERATOR),
    Endpoint("close_site", "DELETE", _SITE, Role.OPERATOR),
    Endpoint("get_fleet", "GET", _SITE + "/fleet", Role.VIEWER),
    Endpoint("get_fleet_poses", "GET", _SITE + "/fleet/poses", Role.VIEWER),
    Endpoint("get_asked_robot", "GET", _FLEET_ROBOT + "/asking", Role.VIEWER),
    Endpoint("take_robot_out", "POST", _FLEET_ROBOT + "/out_of_service", Role.OPERATOR),
    Endpoint("put_robot_back", "POST", _FLEET_ROBOT + "/back_in_service", Role.OPERATOR),
    Endpoint("send_robot", "POST", _FLEET_ROBOT + "/go", Role.OPERATOR),
    Endpoint("tell_of_way", "POST", _SITE + "/fleet/ways", Role.OPERATOR),
    Endpoint("list_requests", "GET", "/api/requests", Role.VIEWER),
    Endpoint("get_request", "GET", _REQUEST, Role.VIEWER),
    Endpoint("make_request", "POST", "/api/requests", Role.HELPER),
    Endpoint("understand_request", "POST", "/api/requests/understand", Role.HELPER),
    Endpoint("change_request", "PUT", _REQUEST, Role.HELPER),
    Endpoint("cancel_request", "DELETE", _REQUEST, Role.HELPER),
    Endpoint("list_runs", "GET", "/api/runs", Role.VIEWER),
    Endpoint("get_run", "GET", _RUN, Role.VIEWER),
    Endpoint("list_events", "GET", _RUN + "/events", Role.VIEWER),
    Endpoint("get_run_report", "GET", _RUN + "/report", Role.VIEWER),
    Endpoint("export_run", "GET", _RUN + "/export", Role.VIEWER),
    Endpoint("get_camera_picture", "GET", _RUN + "/cameras/{camera}", Role.VIEWER),
    Endpoint("get_layout", "GET", _RUN + "/layout", Role.VIEWER),
    Endpoint("get_poses", "GET", _RUN + "/poses", Role.VIEWER),
    Endpoint("record_cameras", "POST", _RUN + "/recordings", Role.OPERATOR),
    Endpoint("start_run", "POST", "/api/runs", Role.OPERATOR),
    Endpoint("pause_run", "POST", _RUN + "/pause", Role.OPERATOR),
    Endpoint("resume_run", "POST", _RUN + "/resume", Role.OPERATOR),
    Endpoint("abort_run", "POST", _RUN + "/abort", Role.OPERATOR),
    Endpoint("intervene", "POST", _RUN + "/interventions", Role.OPERATOR),
    Endpoint("take_leaf", "POST", _RUN + "/leaves/take", Role.HELPER),
    Endpoint("give_leaf_back", "POST", _RUN + "/leaves/give_back", Role.HELPER),
    Endpoint("say_of_leaf", "POST", _RUN + "/leaves/say", Role.HELPER),
    Endpoint("get_steering", "GET", _RUN + "/steering", Role.VIEWER),
    Endpoint("get_steering_offers", "GET", _RUN + "/steering/offers", Role.VIEWER),
    Endpoint("steer_run", "POST", _RUN + "/steering", Role.OPERATOR),
    Endpoint("list_issues", "GET", "/api/issues", Role.VIEWER),
    Endpoint("get_statistics", "GET", "/api/statistics", Role.VIEWER),
    Endpoint("list_dialogues", "GET", "/api/dialogues", Role.VIEWER),
    Endpoint("get_dialogue", "GET", _DIALOGUE, Role.VIEWER),
    Endpoint("list_questions", "GET", "/api/questions", Role.VIEWER),
    Endpoint("list_helpers", "GET", "/api/helpers", Role.VIEWER),
    Endpoint("choose_for_all", "POST", "/api/questions/choices", Role.HELPER),
    Endpoint("answer_prompt", "POST", _DIALOGUE + "/answers", Role.HELPER),
    Endpoint("choose_way", "POST", _DIALOGUE + "/choices", Role.HELPER),
    Endpoint("claim_dialogue", "POST", _DIALOGUE + "/claim", Role.HELPER),
    Endpoint("release_dialogue", "POST", _DIALOGUE + "/release", Role.HELPER),
    Endpoint("extend_deadline", "POST", _DIALOGUE + "/extend", Role.HELPER),
    Endpoint("say_help_is_done", "POST", _DIALOGUE + "/done", Role.HELPER),
    Endpoint("take_back_promise", "POST", _DIALOGUE + "/take_back", Role.HELPER),
    Endpoint("get_push", "GET", "/api/push", Role.VIEWER),
    Endpoint("list_push_subscriptions", "GET", _DEVICES, Role.HELPER),
    Endpoint("add_push_subscription", "POST", _DEVICES, Role.HELPER),
    Endpoint("end_push_subscription", "DELETE", _DEVICES + "/{device}", Role.HELPER),
    Endpoint("try_push_subscription", "POST", _DEVICES + "/{device}/trial", Role.HELPER),
    Endpoint("list_robots", "GET", "/api/robots", Role.VIEWER),
    Endpoint("enrol_robot", "POST", "/api/robots/enrol", OPEN),
    Endpoint("get_picture", "GET", "/api/pictures/{picture}", Role.VIEWER),
    Endpoint("list_models", "GET", "/api/models", Role.VIEWER),
    Endpoint("get_model", "GET", "/api/models/{model}", Role.VIEWER),
    Endpoint("put_model", "PUT", "/api/models/{model}", Role.OPERATOR),
    Endpoint("delete_model", "DELETE", "/api/models/{model}", Role.OPERATOR),
    Endpoint("put_own_model", "PUT", "/api/robots/own_model", Role.ROBOT),
    Endpoint("delete_own_model", "DELETE", "/api/robots/own_model", Role.ROBOT),
    Endpoint("get_model_file", "GET", "/api/models/{model}/{file:path}", Role.VIEWER),
    Endpoint("get_speech", "GET", "/api/speech", Role.VIEWER),
    Endpoint("get_phrase_speech", "GET", "/api/speech/phrases/{name}", Role.VIEWER),
    Endpoint("get_prompt_speech", "GET", _SPEECH, Role.VIEWER),
    Endpoint("get_prompt_help_speech", "GET", _SPEECH + "/help", Role.VIEWER),
    Endpoint("get_prompt_effect_speech", "GET", _SPEECH + "/{answer}", Role.VIEWER),
    Endpoint("list_principals", "GET", "/api/access/principals", Role.ADMIN),
    Endpoint("add_principal", "POST", "/api/access/principals", Role.ADMIN),
    Endpoint("rotate_principal", "POST", _PRINCIPAL + "/rotate", Role.ADMIN),
    Endpoint("revoke_principal", "DELETE", _PRINCIPAL, Role.ADMIN),
    Endpoint("open_enrolment", "POST", "/api/access/enrolments", Role.ADMIN),
    Endpoint("list_deeds", "GET", "/api/access/deeds", Role.ADMIN),
    Endpoint("healthz", "GET", "/healthz", OPEN),
    Endpoint("readyz", "GET", "/readyz", OPEN),
    Endpoint("metrics", "GET", "/metrics", Role.VIEWER),
)

SOCKETS: Mapping[str, Role] = {
    "/ws/helper": Role.VIEWER,
    "/ws/live": Role.VIEWER,
    "/ws/speech": Role.HELPER,
    "/ws/robot": Role.ROBOT,
}
"""Who may open each WebSocket. Robots may also show the service's own token there."""

MESSAGES: Mapping[str, Mapping[str, Role | None]] = {
    "/ws/helper": {
        "auth": OPEN,
        "ping": Role.VIEWER,
        "answer": Role.HELPER,
        "choose": Role.HELPER,
        "claim": Role.HELPER,
        "release": Role.HELPER,
        "extend": Role.HELPER,
        "done": Role.HELPER,
        "take_back": Role.HELPER,
        "here": Role.VIEWER,
    },
    "/ws/live": {"auth": OPEN},
    "/ws/speech": {
        "auth": OPEN,
        "listen": Role.HELPER,
        "spoken": Role.HELPER,
        "cancel": Role.HELPER,
    },
    "/ws/robot": {
        "hello": Role.ROBOT,
        "report": Role.ROBOT,
        "heartbeat": Role.ROBOT,
        "taken": Role.ROBOT,
        "picture": Role.ROBOT,
        "poses": Role.ROBOT,
    },
}
"""What each message of a client needs, once its connection is open."""

PATTERNS: tuple[tuple[re.Pattern[str], Endpoint], ...] = tuple(
    (compile_path(each.path)[0], each) for each in ENDPOINTS
)


def needed_for_request(method: str, path: str) -> Role | None:
    """The role that a request needs; None if anybody may send it.

    What has no row needs an admin, so that nothing is open because it was forgotten.
    """
    found = endpoint_of(method, path)
    if found is not None:
        return found.role
    # Of the right path and another method: the service says itself that it cannot be done.
    return Role.VIEWER if any(pattern.match(path) for pattern, _ in PATTERNS) else Role.ADMIN


def endpoint_of(method: str, path: str) -> Endpoint | None:
    """What a request asks for, if it has a row."""
    of_method = (each for each in PATTERNS if each[1].method == method)
    return next((endpoint for pattern, endpoint in of_method if pattern.match(path)), None)


def needed_for_message(socket: str, kind: str) -> Role | None:
    """The role that a message needs; one without a row needs an admin."""
    return MESSAGES[socket].get(kind, Role.ADMIN)

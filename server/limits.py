"""How much of everything there may be; `docs/limits.md` has a row for each."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

AtLeastOne = Annotated[int, Field(ge=1, le=2**31 - 1)]
Seconds = Annotated[float, Field(gt=0.0, le=86_400.0, allow_inf_nan=False)]

SetLimitName = Literal[
    "answers",
    "world_options",
    "option_chars",
    "hello_chars",
    "hello_s",
    "departed_robots",
    "uploaded_chars",
    "model_bytes",
    "models_bytes",
    "waiting_models",
    "waiting_chars",
    "check_s",
    "running_runs",
    "sites",
    "open_requests",
    "connections",
    "connections_per_principal",
    "strangers",
    "strangers_per_address",
    "head_s",
    "body_s",
    "stuck_client_s",
    "incoming_bytes",
    "stranger_body_bytes",
    "wrong_tokens",
    "idempotency_keys",
    "idempotency_s",
    "robot_messages_per_s",
    "helper_messages_per_s",
    "requests_per_s",
    "push_subscriptions",
    "recorded_bytes",
]
"""Those that can be set, as `Limits` has them."""

FixedLimitName = Literal[
    "body_bytes",
    "body_values",
    "helper_message_chars",
    "sound_bytes",
    "stranger_message_bytes",
    "first_message_s",
    "message_bytes",
    "message_parts",
    "pings",
    "robot_numbers",
    "unasked_reports",
    "new_boots",
    "fruitless_commands",
    "untaken_commands",
    "waiting_interventions",
    "claims",
    "extensions",
    "sign_ins",
]
"""Those that are fixed, and counted when something is beyond them."""

LimitName = Literal[SetLimitName, FixedLimitName]
"""The limits by name: whoever refuses something says for which of them."""


class Limits(BaseModel):
    """What is beyond a limit is refused with a sentence that names it, and changes nothing."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    answers: AtLeastOne = 10_000
    """Scripted answers of one run."""
    world_options: AtLeastOne = 100
    """Options of one run for its world."""
    option_chars: AtLeastOne = 1000
    """Characters of the name of such an option, and of one that is text."""
    hello_chars: AtLeastOne = 128 * 1024
    """Characters of a robot's `hello`."""
    hello_s: Seconds = 10.0
    """How long it may take to come, and then its connection to take the place of the last one."""
    departed_robots: AtLeastOne = 100
    """Robots without connection and run that are still listed; those gone longest are forgotten."""
    uploaded_chars: AtLeastOne = 32 * 1024**2
    """Characters of all uploaded files of one kind together."""
    model_bytes: AtLeastOne = 64 * 1024**2
    """Bytes of the files of one uploaded robot model, unpacked, each as often as it is drawn."""
    models_bytes: AtLeastOne = 512 * 1024**2
    """Bytes of all uploaded robot models as they are kept, packed."""
    waiting_models: AtLeastOne = 16
    """Uploaded robot models that are being checked or wait for it; one of each may wait."""
    waiting_chars: AtLeastOne = 64 * 1024**2
    """Characters of what waits to be read and checked as it is large; one piece each may wait."""
    check_s: Seconds = 120.0
    """How long reading and checking one large piece of that may take."""
    running_runs: AtLeastOne = 16
    """Runs that have not ended, at a time; each in a simulated world may take a process."""
    sites: AtLeastOne = 8
    """Sites that are open, at a time; each may take a process."""
    open_requests: AtLeastOne = 500
    """Requests of one fleet that have not ended; each planned occurrence and each series is one."""
    connections: AtLeastOne = 500
    """Connections to the service at a time."""
    connections_per_principal: AtLeastOne = 50
    """Connections of one principal with a credential of their own; for one more the oldest ends."""
    strangers: AtLeastOne = 200
    """Those of them that have not been admitted; for one more the oldest is ended."""
    strangers_per_address: AtLeastOne = 50
    """Such connections from one address."""
    head_s: Seconds = 10.0
    """How long a request's head may take to come, from the connection or its first byte on."""
    body_s: Seconds = 60.0
    """How long the body may take after that."""
    stuck_client_s: Seconds = 30.0
    """How long a client may take nothing of what is sent to it."""
    incoming_bytes: AtLeastOne = 64 * 1024**2
    """Bytes of bodies that come at once, beyond 64 KiB of each; one of everybody may have more."""
    stranger_body_bytes: AtLeastOne = 16 * 1024
    """Bytes of the body of a request that anybody may send."""
    wrong_tokens: AtLeastOne = 5
    """Different wrong tokens from one address before it has to wait for the next."""
    idempotency_keys: AtLeastOne = 1000
    """Requests under an idempotency key that are kept of one principal, the latest ones."""
    idempotency_s: Seconds = 86_400.0
    """How long they are kept."""
    robot_messages_per_s: AtLeastOne = 500
    """Messages of one robot's connection that are read in a second, of 4096 characters each."""
    helper_messages_per_s: AtLeastOne = 100
    """Messages of one helper's connection, of whatever kind, counted in the same way."""
    requests_per_s: AtLeastOne = 100
    """Requests of one principal with a credential of their own that are answered in a second."""
    push_subscriptions: AtLeastOne = 100
    """Devices of one principal that are called; without principals all are of one."""
    recorded_bytes: AtLeastOne = 64 * 1024**2
    """Bytes of what is recorded of the cameras of one run, clips of its issues not counted."""

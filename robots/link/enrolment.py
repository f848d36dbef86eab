"""How a robot gets its own credential: a one-time code, exchanged once, and kept in a file."""

import os
from pathlib import Path
from urllib.parse import urlsplit, urlunsplit

import httpx
from pydantic import BaseModel, ConfigDict, ValidationError

from mend.robots.link.channel import ChannelClosedError, LinkRefusedError

ENROL_PATH = "/api/robots/enrol"
PATIENCE_S = 10.0


class RobotCredential(BaseModel):
    """A robot's own credential, as the service gives it."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    robot: str
    token: str


def robot_credential(url: str, robot: str, file: Path, code: str | None = None) -> str:
    """The credential in a file, or the one that a `code` is exchanged for and that is kept there.

    `url` is that of the robots' socket. To be called before the robot's event loop runs. Raises
    `LinkRefusedError` if there is neither, or the service does not take the code,
    `ChannelClosedError` if there is no service, and `OSError` where the file cannot be read or
    written.
    """
    if file.is_file():
        return file.read_text(encoding="utf-8").strip()
    if code is None:
        raise LinkRefusedError(
            f"the robot '{robot}' has no credential in {file}: make a code for it with "
            f"'mend access enrol {robot}'"
        )
    # Before the code is spent: a credential that cannot be kept would be lost.
    descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8") as kept:
            token = enrol(url, robot, code)
            kept.write(token + "\n")
    except BaseException:
        file.unlink()
        raise
    return token


def enrol(url: str, robot: str, code: str) -> str:
    """Exchange a one-time code for the robot's own credential.

    Raises `LinkRefusedError` if the service does not take the code, and `ChannelClosedError` if
    there is no service, or it asks to wait as too many wrong codes or tokens came from here.
    """
    parts = urlsplit(url)
    scheme = {"ws": "http", "wss": "https"}.get(parts.scheme, parts.scheme)
    address = urlunsplit((scheme, parts.netloc, ENROL_PATH, "", ""))
    try:
        with httpx.Client(timeout=PATIENCE_S, trust_env=False) as client:
            response = client.post(address, json={"robot": robot, "code": code})
    except httpx.TransportError as error:
        raise ChannelClosedError(f"no service at {address}: {error}") from error
    if response.status_code == httpx.codes.TOO_MANY_REQUESTS:
        raise ChannelClosedError(f"{address} asks to wait: {_detail(response)}")
    if response.is_client_error:
        raise LinkRefusedError(f"{address} turned the robot away: {_detail(response)}")
    try:
        response.raise_for_status()
        return RobotCredential.model_validate_json(response.content).token
    except (httpx.HTTPStatusError, ValidationError) as error:
        raise ChannelClosedError(f"{address} answered {response.status_code}") from error


def _detail(response: httpx.Response) -> str:
    try:
        return str(response.json()["detail"])
    except (ValueError, KeyError, TypeError):
        return f"HTTP status {response.status_code}"

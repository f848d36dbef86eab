"""Where the service listens: its socket, and the address by which this machine reaches it."""

import socket

from mend.server.settings import Settings

SEND_BUFFER_BYTES = 256 * 1024
"""What the kernel may hold for a client that does not read; the kernel would go up to megabytes."""


class CannotListenError(OSError):
    """Another program has the port, or this one may not have it."""


def listen(settings: Settings) -> socket.socket:
    """The listening socket. Raises `CannotListenError`, a sentence."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # asyncio turns Nagle's algorithm off only for sockets that name TCP; with it on, a second small
    # message would wait for the acknowledgement of the first, some 40 ms.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
    try:
        listening.bind((settings.host, settings.port))
    except OSError as error:
        listening.close()
        raise CannotListenError(
            f"cannot listen on {settings.host}:{settings.port}: {error.strerror}"
        ) from error
    return listening


def reachable_host(host: str) -> str:
    """The host under which this machine reaches its own service."""
    if host in ("0.0.0.0", ""):
        return "127.0.0.1"
    if host == "::":
        return "[::1]"
    return f"[{host}]" if ":" in host else host

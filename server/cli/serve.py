"""`mend serve`: the service, until it is told to stop."""

import asyncio
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.failures import told_plainly

if TYPE_CHECKING:
    from mend.server.settings import Settings


def serve(
    host: Annotated[
        str | None, typer.Option(help="Address to listen on; all but loopback needs a token.")
    ] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 takes a free one.")] = None,
    journal: Annotated[Path | None, typer.Option(help="The journal's file.")] = None,
    tls_cert: Annotated[
        Path | None,
        typer.Option(help="The service's certificate in PEM: it then speaks HTTPS alone."),
    ] = None,
    tls_key: Annotated[
        Path | None, typer.Option(help="The certificate's private key in PEM.")
    ] = None,
    config: Annotated[Path | None, typer.Option(help="Settings in a TOML file.")] = None,
) -> None:
    """Serve the API, the helper console and the robots' socket.

    Settings come from these options, then from MEND_* variables, then from the file. Runs that had
    not ended when the service stopped go on. Ctrl-C stops it.
    """
    from mend.server.settings import load_settings

    with told_plainly():
        settings = load_settings(
            config,
            host=host,
            port=port,
            journal=journal,
            tls_certificate=tls_cert,
            tls_key=tls_key,
        )
        asyncio.run(_serve(settings))


async def _serve(settings: "Settings") -> None:
    from mend.garbage import settle_garbage
    from mend.server.composition import open_service

    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    async with open_service(settings, recover=True) as service:
        settle_garbage()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, stop.set)
        others = f", others reach it at {settings.public_url}" if settings.public_url else ""
        typer.echo(f"Mend listens on {service.url}{others}; its journal is {settings.journal_path}")
        await stop.wait()

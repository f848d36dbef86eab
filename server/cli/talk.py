"""`mend talk`: a helper at a terminal with a loudspeaker and a microphone."""

import asyncio
import getpass
import os
from typing import Annotated

import typer

from mend.server.cli.failures import INTERRUPTED, CommandLineError

TOKEN_VARIABLE = "MEND_TOKEN"


def talk(
    url: Annotated[str, typer.Option(help="The service.")] = "http://127.0.0.1:8080",
    helper: Annotated[
        str | None, typer.Option(help="Your name; the others see it. [default: your login]")
    ] = None,
    token: Annotated[
        str | None, typer.Option(help="The service's token; better given as MEND_TOKEN.")
    ] = None,
    device: Annotated[str | None, typer.Option(help="The sound device's name or number.")] = None,
) -> None:
    """Join a service as a helper who hears the robot's questions and answers by voice.

    Say yes or no, or: repeat, help, stop. Everything that is said is also printed. Only English
    is understood. Ctrl-C ends it; the runs go on.
    """
    # Imported only here: the client brings the whole API with it.
    from mend.server.cli.sound_device import PortAudioDevice
    from mend.server.cli.spoken_helper import SpokenHelper
    from mend.server.client import MendClient
    from mend.server.client_errors import ClientError

    sound = PortAudioDevice(device)
    name = helper or getpass.getuser()

    async def join() -> None:
        async with MendClient(url, token=token or os.environ.get(TOKEN_VARIABLE)) as client:
            typer.echo(f"Joining {url} as {name}; Ctrl-C ends it.")
            await SpokenHelper(client, name, sound, typer.echo).run()

    plain = (ClientError, CommandLineError)
    try:
        asyncio.run(join())
    except KeyboardInterrupt:
        raise CommandLineError("interrupted", INTERRUPTED) from None
    except plain as error:
        raise CommandLineError(str(error)) from error
    except ExceptionGroup as failed:
        known, _ = failed.split(plain)
        if known is None:
            raise
        raise CommandLineError(str(known.exceptions[0])) from failed

# ruff: noqa: T201
"""Start a run, follow it and answer every question with yes.

Start a service first (`mend serve`); give its token in MEND_TOKEN if it has one.
"""

import asyncio
import os
import sys

from mend.server.client import ENDS, MendClient
from mend.server.journal.events import Prompt
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import Snapshot


async def main(url: str) -> int:
    """Build the EKET base and help wherever the robot asks."""
    async with MendClient(url, token=os.environ.get("MEND_TOKEN")) as client:
        await client.wait_until_ready()
        async with client.follow(helper="example") as stream:
            messages = aiter(stream)
            # Once the first snapshot is here, no event of the run can be missed.
            await anext(messages)
            run = await client.start_run(RunRequest(tree="eket", world="tabletop", speed="max"))
            async for event in messages:
                if isinstance(event, Snapshot) or event.run != run.id:
                    continue
                print(f"{event.time:8.1f} s  {type(event).__name__}")
                if isinstance(event, Prompt) and event.kind == "ask":
                    print(f"            {event.text} - yes")
                    await client.answer(event.dialogue, event.prompt, "yes", "example")
                if isinstance(event, ENDS):
                    break
        ended = await client.run(run.id)
        print(f"the run has {ended.status}")
        return 0 if ended.status == "finished" else 1


if __name__ == "__main__":
    address = sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8080"
    raise SystemExit(asyncio.run(main(address)))

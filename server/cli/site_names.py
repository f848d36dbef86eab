"""How people name sites and scenes of a service on the command line."""

from pathlib import Path

from mend.server.cli.failures import CommandLineError
from mend.server.cli.task_files import is_file, read_text
from mend.server.client import MendClient
from mend.server.sites.views import SiteView
from mend.tasks.scene_file import check_scene_file


async def find_site(client: MendClient, said: str) -> SiteView:
    """The open site of an id, of enough of its beginning, or of a scene that no other has.

    Raises `CommandLineError`, and the client's errors.
    """
    sites = await client.sites()
    wanted = said.lower()
    by_id = [each for each in sites if wanted and str(each.id).startswith(wanted)]
    found = by_id or [each for each in sites if each.scene == said]
    if len(found) == 1:
        return found[0]
    listed = ", ".join(f"{each.id} ({each.scene})" for each in found or sites)
    if found:
        raise CommandLineError(f"'{said}' may be any of the sites {listed}: say more of its id")
    raise CommandLineError(f"no site '{said}' is open; open are: {listed or 'none'}")


async def scene_at(client: MendClient, said: str) -> str:
    """The name of a scene at a service; a file is uploaded for it first.

    Raises `InvalidFileError` for a file with mistakes, `OSError`, and the client's errors.
    """
    if not is_file(said):
        return said
    name = check_scene_file(Path(said)).name
    await client.upload_scene(read_text(Path(said)), name)
    return name

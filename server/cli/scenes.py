"""`mend scenes`: the scenes that come with Mend."""

from mend.server.cli.failures import told_plainly
from mend.server.cli.rows import print_rows


def scenes() -> None:
    """List the scenes that come with Mend: how many objects and places each has."""
    from mend.tasks.library import SCENES
    from mend.tasks.scene_file import built_in_scene

    with told_plainly():
        loaded = [built_in_scene(name) for name in SCENES.names()]
    print_rows(
        [(each.name, str(len(each.objects)), str(len(each.places))) for each in loaded],
        ("scene", "objects", "places"),
    )

"""Whether links and joints are one robot: a tree of links, from one root."""

from collections import Counter
from collections.abc import Iterable

from mend.errors import WrongInputError
from mend.server.models.archive_names import URDF
from mend.server.models.urdf_elements import Joint, Urdf


def check_shape(urdf: Urdf) -> None:
    """Raises `WrongInputError` where links and joints are no tree."""
    _refuse_twice("link", urdf.links)
    _refuse_twice("joint", (each.name for each in urdf.joints))
    links = set(urdf.links)
    for joint in urdf.joints:
        for what, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                raise _wrong(f"the joint '{joint.name}' has no link as its {what}")
    _refuse_twice("child link", (str(each.child) for each in urdf.joints))
    roots = links - {each.child for each in urdf.joints}
    if len(roots) != 1:
        raise _wrong(f"one link has no parent, and not {len(roots)} of them")
    if len(_reached(roots.pop(), urdf.joints)) != len(links):
        raise _wrong("some links are in a loop of joints")
    _check_mimics(urdf.joints)


def _refuse_twice(what: str, names: Iterable[str]) -> None:
    twice = [name for name, count in Counter(names).items() if count > 1]
    if twice:
        raise _wrong(f"the {what} '{twice[0]}' is there more than once")


def _reached(root: str, joints: Iterable[Joint]) -> set[str]:
    below: dict[str | None, list[str]] = {}
    for joint in joints:
        below.setdefault(joint.parent, []).append(str(joint.child))
    reached, new = {root}, [root]
    while new:
        new = [child for link in new for child in below.get(link, ()) if child not in reached]
        reached.update(new)
    return reached


def _check_mimics(joints: Iterable[Joint]) -> None:
    mimics = {each.name: each.mimics for each in joints}
    for name in mimics:
        followed, seen = mimics[name], {name}
        while followed is not None:
            if followed not in mimics:
                raise _wrong(f"the joint '{name}' mimics '{followed}', which is not there")
            if followed in seen:
                raise _wrong(f"the joint '{name}' mimics one that mimics it")
            seen.add(followed)
            followed = mimics[followed]


def _wrong(sentence: str) -> WrongInputError:
    return WrongInputError(f"{URDF}: {sentence}")

"""Meshes and pictures of a model: whether each is what its name says, and what it names itself."""

import re
from collections.abc import Mapping

from mend.errors import WrongInputError
from mend.server.models.archive_names import LONGEST, PICTURES, kind_of, named_file
from mend.server.models.collada_nodes import NodeTally
from mend.server.models.xml_events import read_elements

STL_HEAD_BYTES = 84
STL_FACET_BYTES = 50
STRIDES = frozenset(map(str, range(1, 65)))
OBJ_CORNER = re.compile(rb"(?:^|[\r\n])v ")
MAGIC = {".png": b"\x89PNG\r\n\x1a\n", ".jpg": b"\xff\xd8\xff", ".jpeg": b"\xff\xd8\xff"}


def files_named_in(name: str, content: bytes) -> list[str]:
    """The files that a mesh or picture is drawn with. Raises `WrongInputError`."""
    kind = kind_of(name)
    if kind == ".dae":
        return _pictures_of_collada(name, content)
    good = {".stl": _is_stl, ".obj": _is_obj}.get(kind)
    if not (content.startswith(MAGIC[kind]) if good is None else good(content)):
        raise WrongInputError(f"{name}: it is no {kind.removeprefix('.').upper()} file")
    return []


def _is_stl(content: bytes) -> bool:
    if len(content) < STL_HEAD_BYTES:
        return _is_stl_text(content)
    facets = int.from_bytes(content[STL_HEAD_BYTES - 4 : STL_HEAD_BYTES], "little")
    return len(content) == STL_HEAD_BYTES + STL_FACET_BYTES * facets or _is_stl_text(content)


def _is_stl_text(content: bytes) -> bool:
    return content.lstrip()[:5].lower() == b"solid" and b"endsolid" in content


def _is_obj(content: bytes) -> bool:
    """Text with a corner; the materials that it may name are nobody's."""
    return b"\0" not in content and OBJ_CORNER.search(content) is not None


def _pictures_of_collada(name: str, content: bytes) -> list[str]:
    reader = _Collada(name, len(content))
    read_elements(content, name, reader)
    reader.nodes.check()
    return list(reader.pictures)


class _Collada:
    """Which pictures a COLLADA file names, be it as in version 1.4 or in 1.5.

    And whether it says that it has more than is in it, which a browser would make then.
    """

    def __init__(self, file: str, size: int) -> None:
        self.nodes = NodeTally(file)
        self._corners_left = size
        self._counts: list[str] = []
        self.pictures: dict[str, None] = {}
        """In the order in which they are named, each once."""
        self._file = file
        self._within: list[str] = []
        self._said = ""

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        name = name.rpartition(":")[2]
        if not self._within and name != "COLLADA":
            raise WrongInputError(f"{self._file}: it is no DAE file: it begins with <{name}>")
        self._within.append(name)
        self._said = ""
        self._counts = []
        self.nodes.begin(name, attributes)
        if name == "accessor" and attributes.get("stride", "1") not in STRIDES:
            raise WrongInputError(
                f"{self._file}: 'stride' of an <accessor> is a number of 1 to {len(STRIDES)}"
            )

    def text(self, text: str) -> None:
        # Of what is too long for any name a little more is enough to say so.
        if len(self._said) <= LONGEST and self._names_picture():
            self._said += text.lstrip() if not self._said else text
        if self._within[-1] == "vcount":
            self._counts.append(text)

    def end(self, name: str) -> None:
        self.nodes.end(name.rpartition(":")[2])
        if self._counts:
            self._count_corners("".join(self._counts))
            self._counts = []
        if self._names_picture() and self._said.strip():
            self.pictures[named_file(self._said.strip(), self._file, PICTURES)] = None
        self._said = ""
        self._within.pop()

    def _count_corners(self, said: str) -> None:
        try:
            counts = [int(each) for each in said.split()]
        except ValueError:
            counts = [-1]
        self._corners_left -= sum(counts)
        if self._corners_left < 0 or min(counts, default=0) < 0:
            raise WrongInputError(f"{self._file}: its <vcount> are of more corners than there are")

    def _names_picture(self) -> bool:
        return self._within[-2:] == ["image", "init_from"] or self._within[-3:] == [
            "image", "init_from", "ref",
        ]  # fmt: skip

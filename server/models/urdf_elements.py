"""A URDF as links and joints, with the mistakes that would keep a browser from drawing it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from mend.errors import WrongInputError
from mend.server.models.archive_names import MESHES, PICTURES, URDF, named_file
from mend.server.models.xml_events import read_elements

MOST_LINKS = 1000
MOST_SHAPES = 5000
JOINT_TYPES = frozenset({"fixed", "revolute", "continuous", "prismatic", "planar", "floating"})
SHAPES = frozenset({"box", "sphere", "cylinder", "capsule", "mesh"})

NUMBERS: Mapping[tuple[str, str], int] = {
    ("origin", "xyz"): 3,
    ("origin", "rpy"): 3,
    ("axis", "xyz"): 3,
    ("box", "size"): 3,
    ("mesh", "scale"): 3,
    ("sphere", "radius"): 1,
    ("cylinder", "radius"): 1,
    ("cylinder", "length"): 1,
    ("color", "rgba"): 4,
    ("limit", "lower"): 1,
    ("limit", "upper"): 1,
    ("mimic", "multiplier"): 1,
    ("mimic", "offset"): 1,
}
"""The attributes of which a browser makes numbers, and how many each has."""

NEEDED: Mapping[str, str] = {
    "axis": "xyz",
    "box": "size",
    "sphere": "radius",
    "cylinder": "radius",
    "mesh": "filename",
    "color": "rgba",
    "mimic": "joint",
}
"""What an element is nothing without."""


@dataclass(slots=True)
class Joint:
    """A joint as far as its robot's shape goes; `mimics` is the joint that it follows."""

    name: str
    parent: str | None = None
    child: str | None = None
    mimics: str | None = None


@dataclass(slots=True)
class Urdf:
    """The description of a robot; `files` are those that it is drawn with."""

    links: list[str] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    files: list[str] = field(default_factory=list)


def read_urdf(content: bytes) -> Urdf:
    """Read a description. Raises `WrongInputError`."""
    reader = _Reader()
    read_elements(content, URDF, reader)
    return reader.urdf


class _Reader:
    """Where it is in the document, and what it has read of it."""

    def __init__(self) -> None:
        self.urdf = Urdf()
        self._within: list[str] = []
        self._shapes = 0
        self._visuals = 0

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        path = (*self._within, name)
        self._within.append(name)
        if ":" in name and name.partition(":")[0] == "xacro":
            raise _wrong(f"<{name}> is xacro: expand it first ('xacro model.xacro')")
        if len(path) == 1 and name != "robot":
            raise _wrong(f"the outermost element is <robot>, not <{name}>")
        if path == ("robot", "link"):
            self.urdf.links.append(_name(name, attributes))
        elif path == ("robot", "joint"):
            self._begin_joint(attributes)
        elif path[:2] == ("robot", "joint"):
            self._in_joint(name, attributes)
        if len(self.urdf.links) > MOST_LINKS or len(self.urdf.joints) > MOST_LINKS:
            raise _wrong(f"it has more than {MOST_LINKS} links or joints")
        if path[1:2] in (("link",), ("joint",), ("material",)):
            self._check_values(name, attributes)
        if path[:3] == ("robot", "link", "visual"):
            self._in_visual(path[3:], attributes)
        elif path == ("robot", "material", "texture"):
            self._draw_with(attributes, PICTURES)

    def _begin_joint(self, attributes: Mapping[str, str]) -> None:
        kind = attributes.get("type")
        name = _name("joint", attributes)
        if kind not in JOINT_TYPES:
            raise _wrong(f"the joint '{name}' is of no type of {', '.join(sorted(JOINT_TYPES))}")
        self.urdf.joints.append(Joint(name))

    def _in_joint(self, name: str, attributes: Mapping[str, str]) -> None:
        joint = self.urdf.joints[-1]
        match name:
            case "parent":
                joint.parent = attributes.get("link")
            case "child":
                joint.child = attributes.get("link")
            case "mimic":
                joint.mimics = attributes.get("joint")

    def _check_values(self, name: str, attributes: Mapping[str, str]) -> None:
        needed = NEEDED.get(name)
        if needed is not None and needed not in attributes:
            raise _wrong(f"a <{name}> has no '{needed}'")
        for (element, attribute), count in NUMBERS.items():
            if element == name and attribute in attributes:
                _check_numbers(name, attribute, attributes[attribute], count)

    def _in_visual(self, path: Sequence[str], attributes: Mapping[str, str]) -> None:
        if not path:
            self._visuals += 1
            if self._visuals > MOST_SHAPES:
                raise _wrong(f"it draws more than {MOST_SHAPES} shapes")
        elif path == ("geometry",):
            self._shapes = 0
        elif len(path) == 2 and path[0] == "geometry":
            self._shapes += 1
            if path[1] not in SHAPES:
                raise _wrong(f"a <geometry> is one of {', '.join(sorted(SHAPES))}, not {path[1]}")
            if path[1] == "mesh":
                self._draw_with(attributes, MESHES)
        elif path == ("material", "texture"):
            self._draw_with(attributes, PICTURES)

    def _draw_with(self, attributes: Mapping[str, str], kinds: frozenset[str]) -> None:
        said = attributes.get("filename")
        if said:
            self.urdf.files.append(named_file(said, URDF, kinds))

    def text(self, text: str) -> None:
        """What is said between elements means nothing."""

    def end(self, name: str) -> None:
        self._within.pop()
        if name == "geometry" and self._within == ["robot", "link", "visual"] and self._shapes != 1:
            raise _wrong(f"the link '{self.urdf.links[-1]}' has a <geometry> without one shape")


def _name(element: str, attributes: Mapping[str, str]) -> str:
    name = attributes.get("name")
    if not name or any(each in name for each in '"\\\n'):
        raise _wrong(f"a <{element}> has no name, or one with quotation marks")
    return name


def _check_numbers(element: str, attribute: str, said: str, count: int) -> None:
    try:
        numbers = [float(each) for each in said.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        what = "a number" if count == 1 else f"{count} numbers with blanks between"
        raise _wrong(f"'{attribute}' of a <{element}> is {what}, not {said[:60]!r}")


def _wrong(sentence: str) -> WrongInputError:
    return WrongInputError(f"{URDF}: {sentence}")

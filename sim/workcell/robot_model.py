"""The PR2 as this world needs it: trimmed and repaired from the `example-robot-data` package.

The files are made once and kept in the user's cache folder.
"""

import importlib.util
import math
import os
import re
import shutil
import tempfile
import xml.etree.ElementTree as ElementTree
from importlib import metadata
from pathlib import Path

from mend.sim.workcell.mesh_repair import repair_stl
from mend.sim.world import WorldUnavailableError

ARM_JOINTS = (
    "r_shoulder_pan_joint",
    "r_shoulder_lift_joint",
    "r_upper_arm_roll_joint",
    "r_elbow_flex_joint",
    "r_forearm_roll_joint",
    "r_wrist_flex_joint",
    "r_wrist_roll_joint",
)
FINGER_JOINTS = (
    "r_gripper_l_finger_joint",
    "r_gripper_r_finger_joint",
    "r_gripper_l_finger_tip_joint",
    "r_gripper_r_finger_tip_joint",
)
TOOL_FRAME = "r_gripper_tool_frame"
SHOULDER_FRAME = "r_shoulder_pan_link"
HEAD_CAMERA_FRAME = "wide_stereo_optical_frame"
FOREARM_CAMERA_FRAME = "r_forearm_cam_optical_frame"

NEUTRAL_RAD = (-1.9, -0.25, -1.0, -1.9, -1.0, -1.0, 0.0)
"""Arm joint angles at which the arm hides nothing of the table from the head camera."""

PREFERRED_RAD = (-0.5, 0.3, -1.2, -1.6, -1.2, -1.2, 0.0)
"""Arm joint angles in the middle of the work, elbow out to the right."""

HEAD_FOV_RAD = math.radians(55.0)
"""Vertical field of view of the head camera."""

FOREARM_FOV_RAD = math.radians(90.0)
"""Horizontal field of view of the forearm camera."""

_TORSO_LIFT_M = 0.3
_FIXED_ANGLES_RAD = {
    "head_pan_joint": (0.0, 0.0, -0.345),
    "head_tilt_joint": (0.0, 0.98, 0.0),
    "l_shoulder_pan_joint": (0.0, 0.0, 1.2),
}
_KEPT_VISUALS = re.compile(r"r_|torso|base_link")
_KEPT_COLLISIONS = re.compile(r"r_(gripper|wrist|forearm)")
_MESH_PREFIX = "package://example-robot-data/robots/pr2_description/meshes/"

MODEL = "pr2"
URDF = "robot.urdf"

_TIP_LINKS = {"r_gripper_l_finger_tip_link": -1.0, "r_gripper_r_finger_tip_link": 1.0}
"""Which way along its y axis a fingertip closes."""
_TIP_MASS_KG = 0.2
"""Stands for the drive's inertia, which fingers feel through their gears. Much lighter than what
they hold, the engine's solver would not converge, and what they hold would creep."""

_MODULES = {"ruckig": "ruckig", "pinocchio": "Pinocchio", "coal": "coal"}
"""What the arm plans and moves by, as it is imported and as it is called."""

_PAD_M = (0.031, 0.004, 0.019)
_PAD_AT_M = (0.013, 0.01487, 0.0)
"""The flat inner side of a fingertip: extents, and its middle in the tip's frame, y inward.

It ends where the engine's margin around the mesh ends. The engine finds up to four points at once
where boxes meet, but one where a mesh does, and a heavy part turns on that while it is carried."""
_BEHIND_PAD_M = 0.001
"""So far is the tip's mesh drawn back, to touch only what the pad does not."""

_LAYOUT = 5
"""Raised whenever this module makes different files from the same package."""


def check_installed() -> None:
    """Raise `WorldUnavailableError` where PyBullet or the robot's description is missing."""
    if importlib.util.find_spec("pybullet") is None:
        raise WorldUnavailableError(
            "the workcell world needs PyBullet, which has wheels for Python 3.10 and 3.11 only: "
            "run Mend with Python 3.11 and install it as 'mend-robots[workcell]'"
        )
    for module, called in _MODULES.items():
        if importlib.util.find_spec(module) is None:
            raise WorldUnavailableError(
                f"the workcell world needs {called}: install Mend as 'mend-robots[workcell]'"
            )
    _find_description()


def robot_urdf() -> Path:
    """The trimmed robot's URDF; made on the first call on a machine.

    Raises `WorldUnavailableError` when the package it is made from is missing.
    """
    source, version = _find_description()
    target = _cache_root() / f"pr2-{version}-{_LAYOUT}"
    if not target.exists():
        _make(source, target)
    return target / URDF


def _find_description() -> tuple[Path, str]:
    try:
        package = metadata.distribution("example-robot-data")
    except metadata.PackageNotFoundError:
        raise WorldUnavailableError(
            "the workcell world needs the package example-robot-data: "
            "install Mend as 'mend-robots[workcell]'"
        ) from None
    folder = Path(
        str(package.locate_file("cmeel.prefix/share/example-robot-data/robots/pr2_description"))
    )
    if not (folder / "urdf" / "pr2.urdf").is_file():
        raise WorldUnavailableError(
            f"example-robot-data {package.version} has no PR2 in it: install version 6.0.0"
        )
    return folder, package.version


def _cache_root() -> Path:
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "mend"


def _make(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=f"{target.name}.", dir=target.parent))
    try:
        _write_model(source, draft)
        draft.rename(target)
    except OSError:
        # Another process may have made the same files meanwhile; only one rename can win.
        if not target.exists():
            raise
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _write_model(source: Path, folder: Path) -> None:
    robot = ElementTree.parse(source / "urdf" / "pr2.urdf").getroot()
    for tag in ("gazebo", "transmission"):
        for element in robot.findall(tag):
            robot.remove(element)
    for joint in robot.findall("joint"):
        _trim_joint(joint)
    for link in robot.findall("link"):
        _trim_link(link)
    for mesh in robot.iter("mesh"):
        name = mesh.get("filename", "").removeprefix(_MESH_PREFIX)
        mesh.set("filename", f"meshes/{name}")
        repaired = folder / "meshes" / name
        if not repaired.exists():
            repaired.parent.mkdir(parents=True, exist_ok=True)
            repaired.write_bytes(repair_stl((source / "meshes" / name).read_bytes()))
    ElementTree.ElementTree(robot).write(folder / URDF)


def _trim_joint(joint: ElementTree.Element) -> None:
    """Fix all joints but those of the right arm and its gripper."""
    name = joint.get("name", "")
    obsolete = {"safety_controller", "calibration"}
    if name in FINGER_JOINTS:
        obsolete.add("mimic")
    elif name not in ARM_JOINTS:
        _pose_fixed_joint(name, joint)
        joint.set("type", "fixed")
        obsolete |= {"mimic", "limit", "dynamics", "axis"}
    for tag in obsolete:
        for element in joint.findall(tag):
            joint.remove(element)


def _pose_fixed_joint(name: str, joint: ElementTree.Element) -> None:
    origin = joint.find("origin")
    if origin is None:
        return
    if name == "torso_lift_joint":
        x, y, z = (float(part) for part in origin.get("xyz", "0 0 0").split())
        origin.set("xyz", f"{x} {y} {z + _TORSO_LIFT_M}")
    if name in _FIXED_ANGLES_RAD:
        origin.set("rpy", " ".join(str(angle) for angle in _FIXED_ANGLES_RAD[name]))


def _trim_link(link: ElementTree.Element) -> None:
    name = link.get("name", "")
    if not _KEPT_COLLISIONS.match(name):
        for element in link.findall("collision"):
            link.remove(element)
    if not _KEPT_VISUALS.match(name):
        for element in link.findall("visual"):
            link.remove(element)
    if name in _TIP_LINKS:
        _weigh(link, _TIP_MASS_KG)
        _add_pad(link, inward=_TIP_LINKS[name])
    if link.find("inertial") is None:
        # PyBullet gives a link without inertia a mass of 1 kg.
        inertial = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(inertial, "mass", value="0.001")
        ElementTree.SubElement(
            inertial,
            "inertia",
            {"ixx": "1e-6", "iyy": "1e-6", "izz": "1e-6", "ixy": "0", "ixz": "0", "iyz": "0"},
        )


def _add_pad(link: ElementTree.Element, inward: float) -> None:
    """Touch by a flat pad, in front of the mesh."""
    for origin in link.iterfind("collision/origin"):
        origin.set("xyz", f"0 {-inward * _BEHIND_PAD_M} 0")
    pad = ElementTree.SubElement(link, "collision")
    x, y, z = _PAD_AT_M
    ElementTree.SubElement(pad, "origin", xyz=f"{x} {inward * y} {z}", rpy="0 0 0")
    geometry = ElementTree.SubElement(pad, "geometry")
    ElementTree.SubElement(geometry, "box", size=" ".join(str(each) for each in _PAD_M))


def _weigh(link: ElementTree.Element, mass_kg: float) -> None:
    """Give a link another mass, and the inertia of the same shape."""
    for mass in link.iterfind("inertial/mass"):
        ratio = mass_kg / float(mass.get("value", "1"))
        mass.set("value", str(mass_kg))
        for inertia in link.iterfind("inertial/inertia"):
            for axis, value in inertia.items():
                inertia.set(axis, str(float(value) * ratio))

"""The PR2's gripper as convex pieces, which may hide what it holds: its meshes' convex hulls."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from mend.robots.arm.motion.kinematics import KinematicChain
from mend.sim.workcell.mesh_repair import read_stl
from mend.sim.workcell.robot_model import ARM_JOINTS, FINGER_JOINTS, TOOL_FRAME

Hull = NDArray[np.float64]
"""Corners (n, 3)."""

_PALM = "r_gripper_palm_link"
_LEFT, _RIGHT, _LEFT_TIP, _RIGHT_TIP = FINGER_JOINTS
_MOVING: Mapping[str, tuple[str, ...]] = {
    "r_gripper_l_finger_link": (_LEFT,),
    "r_gripper_r_finger_link": (_RIGHT,),
    "r_gripper_l_finger_tip_link": (_LEFT, _LEFT_TIP),
    "r_gripper_r_finger_tip_link": (_RIGHT, _RIGHT_TIP),
}


class FingerHulls:
    """Knows the pieces once, and where they are by the fingers' angles."""

    def __init__(self, urdf: Path) -> None:
        still = np.zeros(len(ARM_JOINTS))
        from_base = np.linalg.inv(KinematicChain(urdf, TOOL_FRAME, ARM_JOINTS).pose(still))
        palm = from_base @ KinematicChain(urdf, _PALM, ARM_JOINTS).pose(still)
        self._from_base = from_base
        self._palm = _moved(drawn_hull(urdf, _PALM), palm)
        self._chains = {
            link: KinematicChain(urdf, link, (*ARM_JOINTS, *joints))
            for link, joints in _MOVING.items()
        }
        self._hulls = {link: drawn_hull(urdf, link) for link in _MOVING}

    def at(self, angles: Mapping[str, float]) -> Sequence[Hull]:
        """All pieces in the tool frame; `angles` are those of the finger joints."""
        pieces = [self._palm]
        for link, joints in _MOVING.items():
            turned = np.concatenate(
                [np.zeros(len(ARM_JOINTS)), [angles[joint] for joint in joints]]
            )
            pieces.append(
                _moved(self._hulls[link], self._from_base @ self._chains[link].pose(turned))
            )
        return pieces


@cache
def pr2_finger_hulls(urdf: Path) -> FingerHulls:
    """Those of the PR2 in this file; read on the first call, as every world has the same."""
    return FingerHulls(urdf)


def drawn_hull(urdf: Path, link: str) -> Hull:
    """The corners of a link's drawn mesh's convex hull, in the link's frame."""
    root = ElementTree.parse(urdf).getroot()
    visual = root.find(f"link[@name='{link}']/visual")
    mesh = None if visual is None else visual.find("geometry/mesh")
    if visual is None or mesh is None:
        raise ValueError(f"expected a drawn mesh on '{link}' in {urdf.name}, found none")
    points = read_stl((urdf.parent / mesh.get("filename", "")).read_bytes())["corners"]
    corners = points.reshape(-1, 3).astype(np.float64)
    corners = corners[ConvexHull(corners).vertices]
    origin = visual.find("origin")
    frame = np.eye(4)
    if origin is not None:
        frame[:3, 3] = [float(each) for each in origin.get("xyz", "0 0 0").split()]
        turn = [float(each) for each in origin.get("rpy", "0 0 0").split()]
        frame[:3, :3] = Rotation.from_euler("xyz", turn).as_matrix()
    return _moved(corners, frame)


def _moved(points: Hull, frame: NDArray[np.float64]) -> Hull:
    moved: Hull = points @ frame[:3, :3].T + frame[:3, 3]
    return moved

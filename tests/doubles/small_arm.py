"""A six-jointed arm, 1.4 m high when stretched, whose last joint turns freely."""

from pathlib import Path

from mend.robots.arm.motion.kinematics import KinematicChain

_LINKS = (
    ("z", 0.0),
    ("y", 0.3),
    ("y", 0.5),
    ("z", 0.2),
    ("y", 0.2),
    ("z", 0.1),
)
JOINTS = tuple(f"j{number}" for number in range(1, 7))


def small_arm(folder: Path) -> KinematicChain:
    """Write the arm's URDF to `folder` and read it."""
    urdf = folder / "arm.urdf"
    urdf.write_text(_urdf(), encoding="utf-8")
    return KinematicChain(urdf, "tool", JOINTS)


def _urdf() -> str:
    lines = ['<robot name="arm"><link name="base"/>']
    parent = "base"
    for number, (axis, height) in enumerate(_LINKS, start=1):
        child = f"l{number}"
        turns_freely = number == len(_LINKS)
        kind = "continuous" if turns_freely else "revolute"
        lines.append(f'<link name="{child}"/><joint name="j{number}" type="{kind}">')
        lines.append(f'<parent link="{parent}"/><child link="{child}"/>')
        lines.append(f'<origin xyz="0 0 {height}"/>')
        lines.append(f'<axis xyz="{"0 0 1" if axis == "z" else "0 1 0"}"/>')
        lines.append("</joint>" if turns_freely else '<limit lower="-2.8" upper="2.8"/></joint>')
        parent = child
    lines.append('<link name="tool"/><joint name="tip" type="fixed">')
    lines.append(f'<parent link="{parent}"/><child link="tool"/><origin xyz="0 0 0.1"/></joint>')
    return "".join([*lines, "</robot>"])

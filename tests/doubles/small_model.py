"""A small robot of one's own: a red box on a foot, a mesh of each kind, and one joint."""

import io
import struct
import zipfile
from collections.abc import Mapping

DESCRIPTION = """\
<robot name="lamp">
  <material name="red"><color rgba="0.9 0.05 0.05 1"/></material>
  <link name="foot">
    <visual><geometry><mesh filename="package://lamp/meshes/foot.stl"/></geometry></visual>
    <visual><geometry><mesh filename="meshes/base.obj"/></geometry></visual>
  </link>
  <link name="arm">
    <visual>
      <origin xyz="0 0 0.5" rpy="0 0 0"/>
      <geometry><box size="0.3 0.3 0.6"/></geometry>
      <material name="red"/>
    </visual>
    <visual><geometry><mesh filename="meshes/shade.dae" scale="1 1 1"/></geometry></visual>
    <collision><geometry><mesh filename="http://elsewhere/arm.stl"/></geometry></collision>
  </link>
  <joint name="elbow" type="revolute">
    <parent link="foot"/><child link="arm"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="1.5" effort="1" velocity="1"/>
  </joint>
</robot>
"""

BARE = """\
<robot name="post">
  <link name="post"><visual><geometry><box size="0.1 0.1 1"/></geometry></visual></link>
</robot>
"""

FACET = ((0, 0, 0), (0.2, 0, 0), (0, 0.2, 0))
STL = (
    bytes(80)
    + struct.pack("<I", 1)
    + struct.pack("<12f", 0, 0, 1, *(value for corner in FACET for value in corner))
    + bytes(2)
)
OBJ = b"v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nf 1 2 3\n"
PNG = b"\x89PNG\r\n\x1a\n and more"
DAE = b"""\
<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 0 0 0.2 0 0 0 0.2 0</float_array>
      <technique_common><accessor source="#a" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n">
    <instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""

FILES: Mapping[str, bytes] = {
    "robot.urdf": DESCRIPTION.encode(),
    "lamp/meshes/foot.stl": STL,
    "meshes/base.obj": OBJ,
    "meshes/shade.dae": DAE,
}


def packed(files: Mapping[str, bytes | None] | None = None) -> bytes:
    """The archive of the lamp, with other files besides or instead; None leaves one out."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as opened:
        for name, content in {**FILES, **(files or {})}.items():
            if content is not None:
                opened.writestr(name, content)
    return archive.getvalue()

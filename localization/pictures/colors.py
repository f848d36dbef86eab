"""The colours of the published pictures (Veloso et al. 2015, Figure 3), as red, green, blue."""

from mend.localization.localizer import PointClass

Color = tuple[int, int, int]

PAPER: Color = (255, 255, 255)
MAP: Color = (40, 70, 200)
TRAJECTORY: Color = (120, 120, 120)
ELLIPSE: Color = (175, 175, 175)
REFERENCE: Color = (200, 30, 30)
TEXT: Color = (30, 30, 30)
CELLS: Color = (205, 205, 205)
JUDGED: Color = (20, 140, 90)
LOST: Color = (220, 40, 30)
NEITHER: Color = (235, 160, 20)
POINTS: dict[PointClass, Color] = {
    PointClass.LTF: (255, 140, 0),
    PointClass.STF: (140, 30, 170),
    PointClass.DF: (30, 160, 60),
}

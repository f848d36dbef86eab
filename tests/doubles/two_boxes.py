"""A task of two boxes, of which a person can do one while a robot is at the other."""

BENCH = """
name: small_bench
objects:
  red_box: {color: [0.9, 0.1, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: -0.40}}
  blue_box: {color: [0.1, 0.2, 0.9], size: [0.04, 0.05, 0.05], pose: {x: 0.45, y: 0.40}}
places:
  red_box: {pose: {x: 0.70, y: -0.40}}
  blue_box: {pose: {x: 0.60, y: 0.40}}
"""

BOTH = """
name: both
scene: small_bench
tree:
  and:
    - {behavior: pick_and_place, object: red_box, place: red_box}
    - {behavior: pick_and_place, object: blue_box, place: blue_box}
"""
RED, BLUE = "/0", "/1"

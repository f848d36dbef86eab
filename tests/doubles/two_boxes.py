"""A task of two boxes, of which a person can do one while a robot is at the other.

Both are in reach in every world, in which it is checked whenever it is uploaded.
"""

BENCH = """
name: small_bench
objects:
  red_box: {color: [0.9, 0.1, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: -0.40}}
  blue_box: {color: [0.1, 0.2, 0.9], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: 0.15}}
places:
  red_box: {pose: {x: 0.70, y: -0.40}}
  blue_box: {pose: {x: 0.65, y: 0.15}}
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

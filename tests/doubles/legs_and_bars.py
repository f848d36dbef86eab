"""A bench with two legs and two bars: what is planned with them is checked in a moment."""

SCENE = """
name: legs_and_bars
objects:
  green_leg: {color: [0.1, 0.6, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: -0.40}}
  pink_bar: {color: [0.9, 0.4, 0.6], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: -0.25}}
  yellow_bar: {color: [0.9, 0.8, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: -0.10}}
  blue_leg: {color: [0.1, 0.2, 0.9], size: [0.04, 0.05, 0.05], pose: {x: 0.55, y: 0.15}}
places:
  green_leg: {pose: {x: 0.70, y: -0.40}}
  pink_bar: {pose: {x: 0.70, y: -0.25}}
  yellow_bar: {pose: {x: 0.70, y: -0.10}}
  blue_leg: {pose: {x: 0.65, y: 0.15}}
"""

LEGS = """\
name: legs
scene: legs_and_bars
tree:
  then:
    - {behavior: pick_and_place, object: green_leg, place: green_leg}
    - {behavior: pick_and_place, object: blue_leg, place: blue_leg}
"""

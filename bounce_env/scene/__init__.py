"""Scenes: what a table is made of, and how it is read from a file and written to one."""

from bounce_env.scene.base import Box
from bounce_env.scene.elements import Arc, Ball, Bumper, Element, Flipper, Paddle, Part, Wall, moves
from bounce_env.scene.errors import SceneError
from bounce_env.scene.features import ALL_FEATURES, Feature
from bounce_env.scene.load import as_scene, builtin_scenes, dump_scene, load_scene, scene_from_dict, scene_to_dict
from bounce_env.scene.regions import Field, Sensor
from bounce_env.scene.spec import Scene

__all__ = [
    "ALL_FEATURES",
    "Arc",
    "Ball",
    "Box",
    "Bumper",
    "Element",
    "Feature",
    "Field",
    "Flipper",
    "Paddle",
    "Part",
    "Scene",
    "SceneError",
    "Sensor",
    "Wall",
    "as_scene",
    "builtin_scenes",
    "dump_scene",
    "load_scene",
    "moves",
    "scene_from_dict",
    "scene_to_dict",
]

"""Draws a snapshot of a scene as an RGB array, with pygame and without a display; never steps anything."""

from bounce_env.render.frame_content import Picture
from bounce_env.render.projection import Projection
from bounce_env.render.renderer import Renderer
from bounce_env.render.window import Window

__all__ = ["Picture", "Projection", "Renderer", "Window"]

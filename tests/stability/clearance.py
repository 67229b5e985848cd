"""How deep a ball ever is inside of what stands in its way, seen from outside of the engine."""

import math

from bounce_env.engine.world import World
from bounce_env.report.stability.case import Case, Point, play
from bounce_env.scene import Arc, Bumper, Element, Flipper, Paddle, Scene, Wall


def distance(element: Element, core: list[float] | None, p: Point) -> float:
    """From a point to the surface of an element [m]; inf for what can be passed through.

    core: where the ends of a moving part's core are.
    """
    if core is not None and isinstance(element, Paddle | Flipper | Bumper):
        return _to_segment((core[0], core[1]), (core[2], core[3]), p) - element.radius
    if core is not None and isinstance(element, Wall):
        return _to_segment((core[0], core[1]), (core[2], core[3]), p)
    if isinstance(element, Wall) and not element.one_way:
        return _to_segment(element.start, element.end, p)
    if isinstance(element, Bumper):
        return math.dist(p, element.center) - element.radius
    if isinstance(element, Arc):
        (cx, cy), r = element.center, element.radius
        angle = math.atan2(p[1] - cy, p[0] - cx)
        turned = (angle - element.start_angle) % math.tau
        if element.closed or turned <= element.end_angle - element.start_angle:
            return abs(math.dist(p, element.center) - r)
        ends = (element.start_angle, element.end_angle)
        return min(math.dist(p, (cx + r * math.cos(a), cy + r * math.sin(a))) for a in ends)
    return math.inf


def _to_segment(start: Point, end: Point, p: Point) -> float:
    wx, wy = end[0] - start[0], end[1] - start[1]
    along = (p[0] - start[0]) * wx + (p[1] - start[1]) * wy
    share = min(max(along / (wx * wx + wy * wy), 0.0), 1.0) if along > 0.0 else 0.0
    return math.dist(p, (start[0] + share * wx, start[1] + share * wy))


def size(scene: Scene) -> float:
    """The longer side of what the scene occupies [m]."""
    x0, y0, x1, y1 = scene.bounds
    return max(x1 - x0, y1 - y0)


def deepest(case: Case, samples: int = 40) -> float:
    """The deepest overlap seen at some instants of a run, as a share of the scene's size (and of its offset)."""
    found = [-math.inf]

    def watch(world: World, off: set[str]) -> None:
        scene, p = world.scene, tuple(world.position[0].tolist())
        cores = dict(zip([i for i, _ in scene.parts], world.cores.tolist(), strict=True))
        solid = [(e, cores.get(i)) for i, e in enumerate(scene.elements) if e.name not in off]
        gap = min((distance(e, core, p) for e, core in solid), default=math.inf)
        found.append((scene.ball.radius - gap) / size(scene))

    play(case, pieces=samples, watch=watch)
    return max(found)

"""How deep a ball ever is inside of what stands in its way, seen from outside of the engine."""

import math

from stability_case import Case, Point, play

from bounce_env.scene import Arc, Bumper, Element, Scene, Wall


def distance(element: Element, p: Point) -> float:
    """From a point to the surface of an element [m]; inf for what can be passed through."""
    if isinstance(element, Wall) and not element.one_way:
        (ax, ay), (bx, by) = element.start, element.end
        wx, wy = bx - ax, by - ay
        share = min(max(((p[0] - ax) * wx + (p[1] - ay) * wy) / (wx * wx + wy * wy), 0.0), 1.0)
        return math.dist(p, (ax + share * wx, ay + share * wy))
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


def size(scene: Scene) -> float:
    """The longer side of what the scene occupies [m]."""
    x0, y0, x1, y1 = scene.bounds
    return max(x1 - x0, y1 - y0)


def deepest(case: Case, samples: int = 40) -> float:
    """The deepest overlap seen at some instants of a run, as a share of the scene's size (and of its offset)."""
    found = [-math.inf]

    def watch(scene: Scene, off: set[str], p: Point) -> None:
        gap = min((distance(e, p) for e in scene.elements if e.name not in off), default=math.inf)
        found.append((scene.ball.radius - gap) / size(scene))

    play(case, pieces=samples, watch=watch)
    return max(found)

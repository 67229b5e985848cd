"""The tutorial's first example: every number that is shown, to twelve digits, beside numbers of 50."""

import json
import math
import random

import mpmath
import pytest

from bounce_env.lab.reflection import Reflection

pytestmark = pytest.mark.fast


def asked(**changed):
    values = {
        "do": "reflect", "movement": [[-3.0, 2.5], [1.5, -2.0]], "wall": [[-4.0, -1.5], [4.0, -0.5]],
        "movement_b": 1.0, "movement_f": 1.0, "wall_b": 1.0, "wall_f": 1.0, "radius": 0.0,
    }  # fmt: skip
    return Reflection(folder=None, scene=None, ready=None).answer(json.dumps({**values, **changed}))


def random_case(rng):
    def point():
        return [rng.uniform(-5, 5), rng.uniform(-5, 5)]

    return {
        "movement": [point(), point()], "wall": [point(), point()], "radius": rng.choice([0.0, rng.uniform(0, 1)]),
        "movement_b": rng.uniform(0, 2), "movement_f": rng.random(),
        "wall_b": rng.uniform(0, 2), "wall_f": rng.random(),
    }  # fmt: skip


def with_many_digits(case):
    """The tutorial's formulas, with unit vectors in both places."""
    m = mpmath.mpf
    (a, b), (c, d) = ([[m(x), m(y)] for x, y in case[name]] for name in ("movement", "wall"))
    v1, v2 = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    length = mpmath.hypot(*v2)
    along, normal = (v2[0] / length, v2[1] / length), (v2[1] / length, -v2[0] / length)
    dp1, dp2 = (v1[0] * e[0] + v1[1] * e[1] for e in (along, normal))
    proj1, proj2 = (dp1 * along[0], dp1 * along[1]), (dp2 * normal[0], dp2 * normal[1])
    f, bounciness = m(case["movement_f"]) * m(case["wall_f"]), m(case["movement_b"]) * m(case["wall_b"])
    new = tuple(f * p - bounciness * q for p, q in zip(proj1, proj2, strict=True))
    distance = (a[0] - c[0]) * normal[0] + (a[1] - c[1]) * normal[1]
    side = 1 if distance >= 0 else -1
    share = ip = None
    if -side * dp2 > 0:
        share = (side * distance - m(case["radius"])) / (-side * dp2)
        ip = a[0] + share * v1[0], a[1] + share * v1[1]
        at = (ip[0] - c[0]) * along[0] + (ip[1] - c[1]) * along[1]
        if not (0 <= share <= 1 and 0 <= at <= length):
            share = ip = None
    return {
        "dp1": dp1, "dp2": dp2, "proj1": proj1, "proj2": proj2, "new": new, "new_len": mpmath.hypot(*new),
        "new_angle": mpmath.degrees(mpmath.atan2(new[1], new[0])), "share": share, "ip": ip,
        "printed": (length * (proj1[0] - proj2[0]), length * (proj1[1] - proj2[1])),
    }  # fmt: skip


def test_every_number_is_that_of_the_formulas_to_twelve_digits():
    rng, met = random.Random(0), 0
    with mpmath.workdps(50):
        for _ in range(500):
            case = random_case(rng)
            found, right = asked(**case), with_many_digits(case)
            met += right["share"] is not None
            for name, value in right.items():
                if value is None or (name in ("share", "ip") and found[name] is None):
                    assert found[name] == value, (name, case)
                    continue
                pairs = zip(found[name], value, strict=True) if isinstance(value, tuple) else [(found[name], value)]
                scale = 360.0 if name == "new_angle" else max(1.0, *(float(abs(v)) for _, v in [*pairs]))
                pairs = zip(found[name], value, strict=True) if isinstance(value, tuple) else [(found[name], value)]
                for got, wanted in pairs:
                    assert abs(got - wanted) < 1e-12 * scale, (name, case)
    assert 50 < met < 450


def test_the_rest_of_the_way_goes_on_from_where_they_meet():
    found = asked(movement=[[0.0, 1.0], [1.0, -1.0]], wall=[[-1.0, 0.0], [2.0, 0.0]], wall_b=0.5, radius=0.1)
    assert found["ip"] == pytest.approx((0.45, 0.1))
    assert found["new"] == pytest.approx((1.0, 1.0))
    assert found["end"] == pytest.approx((0.45 + 0.55, 0.1 + 0.55))
    away = asked(movement=[[0.0, 1.0], [1.0, 2.0]], wall=[[-1.0, 0.0], [2.0, 0.0]])
    assert away["ip"] is away["share"] is away["end"] is None
    assert away["new"] == pytest.approx((1.0, -1.0))


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"movement": [[0.0, 0.0], [0.0, 0.0]]}, "movement = .*: its ends must be apart"),
        ({"wall": [[1.0, 1.0], [1.0, 1.0]]}, "wall = .*: its ends must be apart"),
        ({"wall_b": -1.0}, "wall_b = -1.0: .*greater than or equal to 0"),
        ({"wall_f": 1.5}, "wall_f = 1.5: .*less than or equal to 1"),
        ({"radius": "1"}, "radius = '1': .*number"),
        ({"movement": [[0.0, math.inf], [1.0, 0.0]]}, "movement.0.1"),
        ({"more": 1}, "more = 1"),
    ],
)
def test_what_cannot_be_computed_is_refused_with_the_field(changed, words):
    with pytest.raises(ValueError, match=words):
        asked(**changed)

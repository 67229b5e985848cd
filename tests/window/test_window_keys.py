"""From held keys to actions, without a window."""

import numpy as np
import pytest
from gymnasium import spaces

from bounce_env.window.keys import controls_for

ONE = spaces.Box(-1.0, 1.0, (1,), np.float32)
TWO = spaces.Box(np.array([-2.0, -3.0]), np.array([4.0, 5.0]), dtype=np.float64)
FOUR = spaces.Box(-1.0, 1.0, (4,), np.float32)


@pytest.mark.parametrize(
    ("space", "held", "action"),
    [
        (spaces.Discrete(3), [], 1),
        (spaces.Discrete(3), ["left"], 0),
        (spaces.Discrete(3), ["d"], 2),
        (spaces.Discrete(3), ["left", "d"], 1),
        (spaces.Discrete(3), ["left", "a"], 0),
        (spaces.Discrete(4), [], 0),
        (spaces.Discrete(4), ["left shift"], 1),
        (spaces.Discrete(4), ["right shift"], 2),
        (spaces.Discrete(4), ["left", "right"], 3),
        (spaces.Discrete(4), ["a", "p", "up"], 1),
        (spaces.MultiBinary(2), [], [0, 0]),
        (spaces.MultiBinary(2), ["left"], [1, 0]),
        (spaces.MultiBinary(2), ["d"], [0, 1]),
        (spaces.MultiBinary(2), ["a", "right shift"], [1, 1]),
        (ONE, [], [0]),
        (ONE, ["right"], [1]),
        (ONE, ["a"], [-1]),
        (ONE, ["left", "right"], [0]),
        (TWO, ["left", "up"], [-2, 5]),
        (TWO, ["d", "s"], [4, -3]),
        (FOUR, ["a", "w", "right"], [-1, 1, 1, 0]),
        (FOUR, ["down"], [0, 0, 0, -1]),
    ],
)
def test_action_of_keys(space, held, action):
    got = controls_for(space).action(set(held))
    assert space.contains(got)
    np.testing.assert_array_equal(got, action)


@pytest.mark.parametrize(
    "space", [spaces.Discrete(5), spaces.Discrete(3, start=1), spaces.MultiBinary(3), spaces.Dict()]
)
def test_a_space_without_keys_is_refused(space):
    with pytest.raises(ValueError, match=r"must be Discrete\(3\), Discrete\(4\), MultiBinary\(2\) or a Box"):
        controls_for(space)


def test_the_help_says_what_the_keys_move():
    words = {controls_for(space).words for space in (ONE, spaces.Discrete(4), FOUR)}
    assert len(words) == 3
    assert "flippers" in controls_for(spaces.MultiBinary(2)).words

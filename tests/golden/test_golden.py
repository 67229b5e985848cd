"""The same bits on every processor: a hash of play, under three of LLVM's targets.

The hash covers observations, rewards and flags of 64 worlds over 600 steps with fixed seeds and scripted actions. Who
changes it has changed what an id means, and says so in CHANGELOG.md: an agent trained before may play worse after. The
new one is printed by

    python tests/golden/test_golden.py
"""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

GOLDEN = "8262c51e9dfa2cae83b407469567efc32cef76a80a42e55682dc7957aaa47a1e"

WORLDS, STEPS = 64, 600
ROOT = Path(__file__).resolve().parents[2]

# Host: what the user gets. The others have neither AVX nor FMA: what was contracted to a fused multiply-add, or summed
# in another order by a wider vector unit, shows. Only for "generic" does Numba leave out the host's features by itself.
TARGETS = {
    "host": {},
    "generic": {"NUMBA_CPU_NAME": "generic"},
    "nehalem": {"NUMBA_CPU_NAME": "nehalem", "NUMBA_CPU_FEATURES": ""},
}


def scripted_actions() -> np.ndarray:
    """(STEPS, WORLDS) speeds from -1.2 to 1.2, each held for 4 steps, from integers alone."""
    step, world = np.ogrid[: STEPS // 4, :WORLDS]
    return np.repeat((7919 * step + 104729 * world + 31 * step * world) % 97 / 40.0 - 1.2, 4, axis=0)


def play() -> tuple[str, int, float]:
    """The hash, how many episodes ended, and the sum of rewards."""
    import gymnasium as gym

    import bounce_env  # noqa: F401

    digest = hashlib.sha256()
    ended, total = 0, 0.0
    # Sticky actions take every frame by itself; without them, most steps are those in which nothing happens.
    for sticky in (0.0, 0.125):
        envs = gym.make_vec("Bounce/Paddle-v0", num_envs=WORLDS, repeat_action_probability=sticky, time_limit=6.0)
        observations, _ = envs.reset(seed=20)
        digest.update(observations.tobytes())
        for actions in scripted_actions():
            observations, rewards, terminated, truncated, _ = envs.step(actions)
            for part in (observations, rewards, terminated, truncated):
                digest.update(part.tobytes())
            ended, total = ended + int((terminated | truncated).sum()), total + float(rewards.sum())
    return digest.hexdigest(), ended, total


def compiled_for() -> str:
    """Name and features of the processor that the kernels of this process were compiled for."""
    from bounce_env.games.paddle import PaddleGame

    _, name, features = PaddleGame.step_worlds.targetctx.codegen().magic_tuple()
    return f"{name} {features}"


@pytest.mark.parametrize("target", TARGETS)
def test_play_has_the_same_bits_on(target, pytestconfig):
    settings = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
    # The host's kernels are those of all tests; the others have caches of their own, kept from run to run.
    folder = pytestconfig.cache.mkdir(f"golden-{target}")
    cache = {} if target == "host" else {"NUMBA_CACHE_DIR": str(folder)}
    done = subprocess.run(
        [sys.executable, "-W", "error", __file__],
        env=settings | {"PYTHONPATH": str(ROOT)} | cache | TARGETS[target],
        capture_output=True,
        text=True,
        check=True,
    )
    digest, ended, total, processor = done.stdout.split(maxsplit=3)
    assert int(ended) > 500
    assert float(total) > 500
    if target != "host":
        assert processor.startswith(target)
        assert not any(feature in processor for feature in ("+avx", "+fma"))
    assert digest == GOLDEN, "play has changed: if that is meant, say so in CHANGELOG.md (see the top of this file)"


if __name__ == "__main__":
    sys.stdout.write(" ".join(map(str, (*play(), compiled_for()))) + "\n")

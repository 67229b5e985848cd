"""The same bits on every processor: a hash of play, under three of LLVM's targets.

The hash covers observations, rewards and flags of 64 worlds over 600 steps with fixed seeds and scripted actions. Who
changes it has changed what an id means, and says so in CHANGELOG.md: an agent trained before may play worse after. The
new one is printed by

    python -m tests.golden.test_golden Bounce/Paddle-v0
"""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.golden

GOLDEN = {
    "Bounce/Paddle-v0": "882cd901166dabf4fe8977cd69258c1e6eafc5e7b76ef6453636773070917294",
    "Bounce/Pinball-v0": "c4bb17c717273cf9f8dde3a74ed0c051d7cd7b6c351a0eb31a37d47f444563e6",
    "Bounce/Walls-v0": "32b3a39434b8121ea5573ed75362dde336721e19127d8bdec4468dff714e6b03",
}
TIME_LIMITS = {"Bounce/Paddle-v0": 6.0, "Bounce/Pinball-v0": 8.0, "Bounce/Walls-v0": 8.0}

WORLDS, STEPS = 64, 600
ROOT = Path(__file__).resolve().parents[2]

# Host: what the user gets. The others have neither AVX nor FMA: what was contracted to a fused multiply-add, or summed
# in another order by a wider vector unit, shows. Only for "generic" does Numba leave out the host's features by itself.
TARGETS = {
    "host": {},
    "generic": {"NUMBA_CPU_NAME": "generic"},
    "nehalem": {"NUMBA_CPU_NAME": "nehalem", "NUMBA_CPU_FEATURES": ""},
}


def scripted_actions(env_id: str) -> np.ndarray:
    """(STEPS, WORLDS) buttons from 0 to 3 or speeds from -1.2 to 1.2, of walls (STEPS, WORLDS, 4), from integers alone.

    Each is held for 4 steps.
    """
    step, world, end = np.ogrid[: STEPS // 4, :WORLDS, : 4 if env_id == "Bounce/Walls-v0" else 1]
    numbers = (7919 * step + 104729 * world + 31 * step * world + 15485863 * end * (step + 3)) % 97
    actions = numbers % 4 if env_id == "Bounce/Pinball-v0" else numbers / 40.0 - 1.2
    return np.repeat(actions if env_id == "Bounce/Walls-v0" else actions[:, :, 0], 4, axis=0)


def play(env_id: str) -> tuple[str, int, float]:
    """The hash, how many episodes ended, and the sum of rewards."""
    import gymnasium as gym

    import bounce_env  # noqa: F401

    digest = hashlib.sha256()
    ended, total = 0, 0.0
    # Sticky actions take every frame by itself; without them, most steps are those in which nothing happens.
    for sticky in (0.0, 0.125):
        envs = gym.make_vec(env_id, num_envs=WORLDS, repeat_action_probability=sticky, time_limit=TIME_LIMITS[env_id])
        observations, _ = envs.reset(seed=20)
        digest.update(observations.tobytes())
        for actions in scripted_actions(env_id):
            observations, rewards, terminated, truncated, _ = envs.step(actions)
            for part in (observations, rewards, terminated, truncated):
                digest.update(part.tobytes())
            ended, total = ended + int((terminated | truncated).sum()), total + float(rewards.sum())
    return digest.hexdigest(), ended, total


def compiled_for() -> str:
    """Name and features of the processor that the kernels of this process were compiled for."""
    from bounce_env.games.kernels import step_worlds

    _, name, features = step_worlds.targetctx.codegen().magic_tuple()
    return f"{name} {features}"


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("env_id", GOLDEN)
def test_play_has_the_same_bits_on(env_id, target, pytestconfig):
    settings = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
    # The host's kernels are those of all tests; the others have caches of their own, kept from run to run.
    folder = pytestconfig.cache.mkdir(f"golden-{target}")
    cache = {} if target == "host" else {"NUMBA_CACHE_DIR": str(folder)}
    done = subprocess.run(
        [sys.executable, "-W", "error", __file__, env_id],
        env=settings | {"PYTHONPATH": str(ROOT)} | cache | TARGETS[target],
        capture_output=True,
        text=True,
        check=True,
    )
    digest, ended, total, processor = done.stdout.split(maxsplit=3)
    assert int(ended) > 100
    assert abs(float(total)) > 20
    if target != "host":
        assert processor.startswith(target)
        assert not any(feature in processor for feature in ("+avx", "+fma"))
    assert digest == GOLDEN[env_id], (
        "play has changed: if that is meant, say so in CHANGELOG.md (see the top of this file)"
    )


if __name__ == "__main__":
    sys.stdout.write(" ".join(map(str, (*play(sys.argv[1]), compiled_for()))) + "\n")

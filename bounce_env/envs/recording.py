"""What was recorded of a world of an environment, as the engine has it and as a replay."""

from gymnasium.envs.registration import EnvSpec

from bounce_env.engine.recorded import Recorded
from bounce_env.games.batch import Batch
from bounce_env.games.recorder import Episode, run_of
from bounce_env.replay import Replay, replay_of


def recorded_episode(batch: Batch, *, last: bool) -> tuple[Episode, Recorded]:
    """Return the present episode of the recorded world, or the one before it; RuntimeError where there is none."""
    recorder = batch.recorder
    episode = None if recorder is None else recorder.last if last else recorder.present
    if recorder is None:
        raise RuntimeError("nothing is recorded: record() or record_events=True, and then reset()")
    if episode is None:
        which = "one was before it" if last else "the present one began"
        raise RuntimeError(
            f"nothing is recorded of this episode: recording began, or a state was restored, after {which}"
        )
    return episode, run_of(episode, batch.state, recorder.world)


def episode_replay(batch: Batch, spec: EnvSpec | None, *, last: bool) -> Replay:
    """Return the replay of the present episode of the recorded world, or of the one before it."""
    episode, run = recorded_episode(batch, last=last)
    about = {} if spec is None else {"id": spec.id, "kwargs": spec.kwargs}
    return replay_of(
        run,
        score=((step.time, step.score) for step in episode.steps),
        lost=episode.lost,
        about={**about, "seed": episode.origin.seed, "episode": episode.origin.number},
    )

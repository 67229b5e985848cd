"""A run's training: the model, what is done between its updates, and how it is stopped without a loss."""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import configure
from stable_baselines3.common.utils import set_random_seed

from agents.algorithms import Model
from agents.command import say
from agents.curve import Curve, Point
from agents.runs import Run
from agents.task import training_seed

MOST_POINTS = 100
"""Of a learning curve: each the mean of some tens of episodes, or more."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Stop:
    """Whether the process has been asked to end: `signal` is what asked, or None."""

    def __init__(self) -> None:
        self.signal: int | None = None

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Within, the first Ctrl-C or SIGTERM is noted, for the training to end in order; a second one acts as ever."""
        before = {number: signal.signal(number, self._note) for number in SIGNALS}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.signal = number
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        say("\nstopping: the checkpoint is being written ...")


class Bookkeeping(BaseCallback):
    """Between two updates of the policy: note the scores, write a checkpoint from time to time, stop when asked.

    `steps` is what the policy has learned from: what was collected since its last update is lost when training stops.
    """

    def __init__(self, run: Run, curve: Curve, stop: Stop, checkpoint_seconds: float) -> None:
        super().__init__()
        self.run = run
        self.curve = curve
        self.stop = stop
        self.checkpoint_seconds = checkpoint_seconds
        self.scores: list[float] = []
        self.lengths: list[float] = []

    def _on_training_start(self) -> None:
        self.began = time.monotonic() - self.curve.seconds
        self.steps = self.model.num_timesteps
        self.save()

    def _on_rollout_start(self) -> None:
        if time.monotonic() - self.saved >= self.checkpoint_seconds:
            self.save()

    def _on_step(self) -> bool:
        for w in np.flatnonzero(self.locals["dones"]):
            info = self.locals["infos"][w]
            self.scores.append(info["score"])
            self.lengths.append(info["game_seconds"])
        return self.stop.signal is None

    def _on_rollout_end(self) -> None:
        self.steps = self.model.num_timesteps  # the update follows at once, and nothing is saved before it is done
        # In a rollout without an episode's end the curve has a gap; DQN and SAC have rollouts of a few steps.
        done = self.curve.points[-1].steps if self.curve.points else 0
        if self.scores and self.steps - done >= self.run.hyperparameters.n_timesteps / MOST_POINTS:
            means = float(np.mean(self.scores)), float(np.mean(self.lengths))
            self.curve.points.append(Point(self.steps, self.seconds, len(self.scores), *means))
            self.scores.clear()
            self.lengths.clear()

    @property
    def seconds(self) -> float:
        """How long the training has taken, with what it took before it was resumed."""
        return time.monotonic() - self.began

    def save(self) -> None:
        """Write the curve, and after it the checkpoint: so the curve in a run folder is never behind the checkpoint."""
        self.curve.write(self.run.folder)
        self.model.num_timesteps = self.steps
        self.run.save_model(self.model)
        self.saved = time.monotonic()


def new_model(run: Run) -> Model:
    """Return an untrained model; what it draws follows from the run's seed."""
    set_random_seed(run.seed)
    env = run.task.for_sb3(run.hyperparameters.n_envs, training_seed(run.seed, 0))
    # Without a seed of its own: SB3 would seed the environments anew with it.
    parameters = run.hyperparameters
    return _seeded(parameters.algorithm(env=env, device="cpu", **parameters.for_sb3()), run.seed)


def resumed_model(run: Run) -> Model:
    """Return the newest checkpoint, with its optimizer's state, its count of steps, and episodes that it has not met.

    DQN and SAC begin with an empty replay buffer again.
    """
    steps = run.load_model().num_timesteps
    seed = int(np.random.SeedSequence((run.seed, steps)).generate_state(1)[0])
    set_random_seed(seed)
    env = run.task.for_sb3(run.hyperparameters.n_envs, training_seed(run.seed, steps))
    return _seeded(run.load_model(env), seed)


def _seeded(model: Model, seed: int) -> Model:
    """Return the model, what it draws from its action space seeded, too: DQN's exploration and SAC's first actions."""
    model.action_space.seed(seed)
    return model


def learn(run: Run, model: Model, curve: Curve, stop: Stop, *, checkpoint_seconds: float, progress_bar: bool) -> float:
    """Train up to the run's number of steps, or until asked to stop, and write the last checkpoint.

    Returns the seconds that the training has taken. `model` and `curve` are changed in place.
    """
    books = Bookkeeping(run, curve, stop, checkpoint_seconds)
    model.set_logger(configure(str(run.folder / "tensorboard"), ["tensorboard"]))
    with stop.listening():
        model.learn(
            max(run.hyperparameters.n_timesteps - model.num_timesteps, 0),
            callback=books,
            reset_num_timesteps=model.num_timesteps == 0,
            progress_bar=progress_bar,
        )
        books.save()
    model.get_env().close()
    return books.seconds

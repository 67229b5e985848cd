"""What is seen of a batch: observations, be they states or pixels, and pictures and frames of its worlds."""

from collections.abc import Iterable
from functools import partial
from typing import Annotated, Any, Literal, Self

import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from pydantic import model_validator
from pydantic.dataclasses import dataclass

from bounce_env.engine.compile.binding import bind
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State, copy_of_world
from bounce_env.engine.motion.readout import view
from bounce_env.envs.observed_frames import ObservedFrames
from bounce_env.envs.trail import Flight, Trail
from bounce_env.games.batch import Batch
from bounce_env.games.options import CONFIG, options_class, refuse
from bounce_env.render import Picture, Renderer
from bounce_env.render.outline import view_box
from bounce_env.render.projection import LARGEST_SIDE, Projection
from bounce_env.scene.base import Spec
from bounce_env.scene.fields import Allowed, one_of, real_number, true_or_false, whole_number

Pixels = npt.NDArray[np.uint8]

OBSERVED_SIZE = 84
"""Width and height of observed frames for which no size was asked, pixels: as agents for Atari games see."""

LONGEST_TRAIL = 60.0
"""Seconds of a trail: more would cover the field."""

_MOST_LEVELS = 256
"""Levels and sizes of which renderers are kept."""

_PIXELS = f"None or an integer from 1 to {LARGEST_SIDE} (pixels)"
Side = Annotated[int | None, Allowed(_PIXELS, whole_number(1, LARGEST_SIDE, none=True))]
Seconds = Annotated[
    float,
    Allowed(
        f"a finite number >= 0 (seconds), at most {LONGEST_TRAIL:g}", partial(real_number, low=0.0, high=LONGEST_TRAIL)
    ),
]


@options_class
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class ViewOptions(Spec):
    """What a user may choose of what is seen. Raises ValueError for what is not allowed.

    obs: "state" or "pixels", what an agent is given. width, height: of rendered frames in pixels; see `Projection.fit`
    for what is left out. obs_width, obs_height: of frames that an agent is given; grayscale: in grey. trail: seconds of
    the ball's way that are drawn. show_bounces: whether `render` shows the last bounce of a step in place of the step's
    end.
    """

    obs: Annotated[Literal["state", "pixels"], one_of("state", "pixels")] = "state"
    width: Side = None
    height: Side = None
    obs_width: Side = None
    obs_height: Side = None
    grayscale: Annotated[bool, Allowed("True or False", true_or_false)] = False
    trail: Seconds = 0.0
    show_bounces: Annotated[bool, Allowed("True or False", true_or_false)] = False

    @model_validator(mode="after")
    def _check_obs_size(self) -> Self:
        for name in ("obs_width", "obs_height"):
            if self.obs == "state" and getattr(self, name) is not None:
                refuse(name, getattr(self, name), 'None where obs is "state": width and height are those of `render`')
        if self.obs == "state" and self.grayscale:
            refuse("grayscale", True, 'False where obs is "state"')
        return self


class Frames:
    """What the worlds of a batch look like, as `options` say.

    Every reset and step is told by `update`. size: (width, height) of a rendered frame, pixels.
    """

    def __init__(self, batch: Batch, options: ViewOptions) -> None:
        bounds = view_box(batch.game.scenes[0])
        fit = Projection.fit(bounds, options.width, options.height)
        self.size = (fit.width, fit.height)
        self._seen: ObservedFrames | None = None
        self._observed = self.size
        if options.obs == "pixels":
            asked = (options.obs_width, options.obs_height)
            seen = Projection.fit(bounds, *((OBSERVED_SIZE, OBSERVED_SIZE) if asked == (None, None) else asked))
            self._observed = (seen.width, seen.height)
            self._seen = ObservedFrames(batch, seen.width, seen.height, grey=options.grayscale)
        self._batch = batch
        self._trail = options.trail
        self._show_bounces = options.show_bounces
        self._trails = [Trail(self._trail) for _ in range(batch.worlds)] if self._trail > 0 else []
        self._renderers: dict[tuple[int, tuple[int, int]], Renderer] = {}

    def __getstate__(self) -> dict[str, Any]:
        # What draws is made anew when it is needed; surfaces can be neither copied nor sent.
        return {**self.__dict__, "_renderers": {}}

    @property
    def space(self) -> spaces.Box:
        """Of one world's observation; the bounds of a state come from the physics, nothing is clipped to them."""
        game = self._batch.game
        if self._seen is None:
            return spaces.Box(*game.observation_bounds, dtype=np.float32)
        return spaces.Box(0, 255, self._seen.frames.shape[1:], np.uint8)

    @property
    def observations(self) -> Array:
        """What agents see now: (worlds, size) float32, or (worlds, height, width, c) uint8; overwritten by `update`."""
        return self._batch.results.observations if self._seen is None else self._seen.frames

    def update(self, worlds: Iterable[int]) -> None:
        """Some worlds have been reset or stepped: their balls have gone on, and their observations are drawn anew."""
        if not self._trails and self._seen is None:
            return
        rows = np.fromiter(worlds, np.intp)
        if not self._trails and self._seen is not None:
            self._seen.draw(rows)
        for w in rows.tolist() if self._trails else ():
            self._go_on(w)
            if self._seen is not None:
                self._seen.show(w, self._drawn(w, self._picture(w, at_bounce=False, score=False), self._observed))

    def restart(self, worlds: Iterable[int]) -> None:
        """Some worlds go on from another state: what is known of the ways that their balls have come is not theirs."""
        worlds = list(worlds)
        if self._trails:
            for w in worlds:
                self._trails[w] = Trail(self._trail)
        self.update(worlds)

    def picture(self, world: int) -> Picture:
        """Return what a frame of a world shows."""
        return self._picture(world, at_bounce=self._show_bounces, score=True)

    def frame(self, world: int) -> Pixels:
        """Return a new picture of a world, (height, width, 3)."""
        return self._drawn(world, self.picture(world), self.size)

    def _drawn(self, world: int, picture: Picture, size: tuple[int, int]) -> Pixels:
        key = (int(self._batch.episodes["level"][world]), size)
        renderer = self._renderers.get(key)
        if renderer is None:
            while len(self._renderers) >= _MOST_LEVELS:
                del self._renderers[next(iter(self._renderers))]
            renderer = self._renderers[key] = Renderer(
                self._batch.scene(world), *size, targets=self._batch.game.targets, hidden=self._batch.game.hidden
            )
        return renderer.frame(picture)

    def _go_on(self, w: int) -> None:
        world, episode, game = self._batch.state.worlds[w], self._batch.episodes[w], self._batch.game
        ball = (int(episode.seed), int(episode.episodes), int(episode.ball))
        # A step lasts longer where a ball has been served in it: the one that is seen now came from there.
        longest = game.step_seconds * 1.001
        self._trails[w].go_on(ball, Flight.of(self._batch.state, w), float(world.time_hi + world.time_lo), longest)

    def _picture(self, w: int, *, at_bounce: bool, score: bool) -> Picture:
        batch = self._batch
        scene = batch.game.scenes[0]  # the scenes of all levels have as many parts and elements
        shown, row = batch.state, w
        if at_bounce and _has_bounced(shown, w):
            shown, row = _at_flight_start(shown, w), 0
        balls, cores = np.empty((shown.balls.shape[1], 4)), np.empty((len(scene.parts), 4))
        view(batch.bound_state if shown is batch.state else bind(shown), row, balls, cores)
        world = shown.worlds[row]
        return Picture(
            balls=balls[:, :2],
            cores=cores,
            alive=shown.balls["status"][row] != OUT,
            hits=shown.hits[row, : len(scene.elements)].copy(),
            lit=None if batch.memory is None else batch.game.lamps(batch.memory[w]),
            score=float(batch.episodes[w].score) if score else None,
            targets=batch.target_places(np.array([w]))[0],
            trail=self._trails[w].until(float(world.time_hi + world.time_lo)) if self._trails else None,
        )


def _has_bounced(state: State, w: int) -> bool:
    """Return whether the ball's present flight begins at a bounce in the last step: on something that was hit in it."""
    ball = state.balls[w, 0]
    touched = state.touches["element"][w, : ball.touched]
    return bool(ball.status != OUT and (state.hits[w, touched] > 0).any())


def _at_flight_start(state: State, w: int) -> State:
    """One world's state for `view` alone, at the instant at which its ball's present flight began."""
    one = copy_of_world(state, w)
    ball, world = one.balls[0, 0], one.worlds[0]
    world.time_hi, world.time_lo = ball.hi, ball.lo
    if one.motions is not None:
        # A part that has come to a stop since then was still on its way, as commanded.
        late = (one.motions["hi"] + one.motions["lo"] > ball.hi + ball.lo) & (one.motions["velocity"] == 0.0)
        one.motions["velocity"][late] = one.motions["command"][late]
        if one.ends is not None:
            for name in ("x0", "y0", "x1", "y1"):
                one.ends[f"v{name}"][late] = one.ends[f"c{name}"][late]
    return one

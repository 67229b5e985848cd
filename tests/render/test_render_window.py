"""The window, under SDL's dummy driver."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import pytest

from bounce_env.render import Picture, Renderer, Window
from tests.render.pixel_scenes import PADDLE, TABLE

pytestmark = pytest.mark.fast

pygame = pytest.importorskip("pygame")

Pixels = npt.NDArray[np.uint8]


@pytest.fixture(autouse=True)
def _dummy_driver(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    yield
    pygame.display.quit()


@pytest.fixture
def noise() -> Pixels:
    return np.random.default_rng(3).integers(0, 256, (60, 100, 3), dtype=np.uint8)


def on_screen() -> Pixels:
    return pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)


def test_the_window_shows_the_very_pixels_of_the_frame() -> None:
    renderer = Renderer(TABLE)
    window = Window((renderer.projection.width, renderer.projection.height), "Bounce", 1000)
    assert pygame.display.get_caption()[0] == "Bounce"
    for x in (0.2, 0.4, 0.6):
        frame = renderer.frame(Picture([(x, 0.7)], PADDLE, score=x))
        window.show(frame)
        assert (on_screen() == frame).all()


def test_a_frame_need_not_be_contiguous(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    window.show(noise[::-1, ::-1])
    assert (on_screen() == noise[::-1, ::-1]).all()


def test_a_frame_of_another_size_or_type_is_refused(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    for bad in (noise[:50], noise.swapaxes(0, 1), noise.astype(np.float32), noise[..., 0]):
        with pytest.raises(ValueError, match=r"frame has shape .* must be \(60, 100, 3\), uint8"):
            window.show(bad)


@pytest.mark.parametrize("fps", [0, -1, float("nan")])
def test_a_bad_pace_is_refused_before_a_window_opens(fps: float) -> None:
    with pytest.raises(ValueError, match=r"fps = .* must be a number > 0"):
        Window((100, 60), "noise", fps)
    assert not pygame.display.get_init()


def test_each_shown_frame_waits_for_its_turn(noise: Pixels, monkeypatch: pytest.MonkeyPatch) -> None:
    class CountingClock:
        paces: list[float] = []  # noqa: RUF012

        def tick(self, fps: float) -> None:
            self.paces.append(fps)

    monkeypatch.setattr(pygame.time, "Clock", CountingClock)
    window = Window((100, 60), "noise", 30.0)
    for _ in range(5):
        window.show(noise)
    window.close()
    window.show(noise)
    assert CountingClock.paces == [30.0] * 5


def test_close_twice_and_show_afterwards(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    assert not window.closed
    window.close()
    window.close()
    assert window.closed
    assert not pygame.display.get_init()
    window.show(noise)
    assert not pygame.display.get_init()


def test_the_users_click_closes_it(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    window.show(noise)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    window.show(noise)
    assert window.closed
    assert not pygame.display.get_init()


def test_keys_are_handed_on_and_none_are_left(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    window.show(noise)
    pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_LEFT))
    window.show(noise)
    assert [event.key for event in window.events if event.type == pygame.KEYDOWN] == [pygame.K_LEFT]
    assert not pygame.event.peek(pygame.KEYDOWN)
    window.show(noise)
    assert not [event for event in window.events if event.type == pygame.KEYDOWN]
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    window.show(noise)
    assert pygame.QUIT in [event.type for event in window.events]
    window.show(noise)
    assert window.events == []


def test_a_new_window_takes_the_place_of_the_one_before(noise: Pixels) -> None:
    first = Window((50, 40), "first", 1000)
    second = Window((100, 60), "second", 1000)
    second.show(noise)
    assert first.closed
    assert not second.closed
    first.show(np.zeros((40, 50, 3), np.uint8))
    first.close()
    assert not second.closed
    assert (on_screen() == noise).all()


def test_a_display_ended_by_others_counts_as_closed(noise: Pixels) -> None:
    window = Window((100, 60), "noise", 1000)
    pygame.display.quit()
    assert window.closed
    window.show(noise)
    window.close()

"""What the command line takes: each command is a dataclass whose fields are its options. Imports tyro: an extra."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, TypeAlias

import tyro

PROGRAM = "python -m bounce_env"


@dataclass(frozen=True)
class List:
    """List the built-in scenes: what each contains, and its size."""

    def run(self) -> int:
        """Print the list; returns the exit code."""
        from bounce_env.commands.scenes import list_scenes  # noqa: PLC0415 (only what runs is imported)

        return list_scenes()


@dataclass(frozen=True)
class Check:
    """Check scenes: print all that is wrong in their files, then let random balls find what is wrong with the play.

    Each ball is alone in the scene, starts anywhere inside of its walls at up to max_speed, and nobody does anything.
    Problems are places where balls rest or stay out of reach of every part that an agent moves (its reach: the box
    around all that it can sweep, wider by the ball's diameter), what scores but is never touched, balls that score too
    often without coming within reach, balls that leave the scene without crossing a drain, and balls that are crushed
    or have too many events. What scores: bumpers, what kicks, sensors but for drains, and elements whose names begin
    with target, rollover or slingshot.

    Every ball is printed with its start: World(scene).reset(position=..., velocity=...) takes the same way again.
    Exit code: 0 nothing found, 1 problems, 2 bad usage. A first check compiles for one to three minutes.
    """

    files: Annotated[tuple[str, ...], tyro.conf.Positional]
    """Paths of .toml files, or names of built-in scenes."""
    balls: int = 100_000
    """How many, per scene."""
    seed: int = 0
    """Of the balls' starts."""
    seconds: float = 30.0
    """For which a ball is followed at most; a ball that stays out of reach for half of it is stuck."""
    scores: int = 20
    """How often a ball may score without coming within reach."""
    show: int = 20
    """How many lines are printed for one finding; 0 for all."""

    def run(self) -> int:
        """Check the scenes; returns the exit code."""
        from bounce_env.commands.check import check_scenes  # noqa: PLC0415

        return check_scenes(
            self.files, balls=self.balls, seed=self.seed, seconds=self.seconds, scores=self.scores, show=self.show
        )


@dataclass(frozen=True)
class Draw:
    """Draw a scene to a PNG file: what stands where it stands, what moves where it starts."""

    file: Annotated[str, tyro.conf.Positional]
    """Path of a .toml file, or name of a built-in scene."""
    output: Annotated[Path, tyro.conf.arg(aliases=["-o"])]
    """The .png file to write."""
    width: int | None = None
    """Pixels; left out it follows the scene's shape."""
    height: int | None = None
    """Pixels; left out it follows the scene's shape; 560 where both are."""

    def run(self) -> int:
        """Write the picture; returns the exit code."""
        from bounce_env.commands.scenes import draw_scene  # noqa: PLC0415

        return draw_scene(self.file, self.output, self.width, self.height)


@dataclass(frozen=True)
class Scenes:
    """List, check or draw scenes."""

    command: (
        Annotated[List, tyro.conf.subcommand("list")]
        | Annotated[Check, tyro.conf.subcommand("check")]
        | Annotated[Draw, tyro.conf.subcommand("draw")]
    )

    def run(self) -> int:
        """Run the command; returns the exit code."""
        return self.command.run()


@dataclass(frozen=True)
class Play:
    """Play a game with the keyboard, in a window.

    Arrow keys or A and D move; in games with flippers they, or left and right shift, press the left and the right one.
    P pauses, R begins anew, V starts and stops a film, Esc or Q quits.
    """

    game: Annotated[str, tyro.conf.Positional]
    """An id such as Bounce/Paddle-v0, or its short name: paddle."""
    scene: str | None = None
    """A scene of your own: path of a .toml file, or name of a built-in scene. Default: the game's."""
    seed: int | None = None
    """Of the launches; left out, each play has others."""
    width: int | None = None
    """Of the field in pixels; left out it follows the scene's shape."""
    height: int | None = None
    """Of the field in pixels; left out it follows the scene's shape; 720 where both are."""
    films: Path = field(default_factory=Path)
    """Folder for films."""
    frames: int | None = None
    """Stop after so many frames. Default: when you quit."""

    def run(self) -> int:
        """Play; returns the exit code."""
        from bounce_env.commands.play import play_game  # noqa: PLC0415

        return play_game(self)


Command: TypeAlias = Annotated[Scenes, tyro.conf.subcommand("scenes")] | Annotated[Play, tyro.conf.subcommand("play")]


def read(arguments: Sequence[str]) -> Scenes | Play:
    """The command that the words give; for bad ones SystemExit with code 2, after a message."""
    command: Scenes | Play = tyro.cli(
        Command,
        prog=PROGRAM,
        args=arguments,
        description="Scenes and games of bounce_env.",
        config=(tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes),
    )
    return command

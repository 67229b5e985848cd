"""What the command line takes: each command is a dataclass whose fields are its options. Imports tyro: an extra."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import tyro


def program() -> str:
    """Return the program as it was called: bounce-env, or python -m bounce_env."""
    return "bounce-env" if Path(sys.argv[0]).stem == "bounce-env" else "python -m bounce_env"


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
    output: Annotated[Path | None, tyro.conf.arg(aliases=["-o"])] = None
    """The .png file to write. Default: beside the .toml file; for a built-in scene NAME.png in this folder."""
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
    """Play a game with the keyboard, in a window; any key starts it.

    Arrow keys or A and D move; in games with flippers they, or left and right shift, press the left and the right one,
    and with --nudge Z and X shove the table. P pauses, R begins anew, V starts and stops a film, Esc or Q quits.
    The other options are keywords of the games, see help(bounce_env.PinballEnv); left out they are the game's.
    """

    game: Annotated[str, tyro.conf.Positional]
    """An id such as Bounce/Paddle-v0, or its short name: paddle."""
    seed: int | None = None
    """Of the launches; left out, each play has others."""
    films: Path = field(default_factory=Path)
    """Folder for films."""
    frames: int | None = None
    """Stop after so many frames, without waiting for a key. Default: when you quit."""
    scene: str | None = None
    """A scene of your own: path of a .toml file, or name of a built-in scene."""
    width: int | None = None
    """Of the field in pixels; left out it follows the scene's shape."""
    height: int | None = None
    """Of the field in pixels; left out it follows the scene's shape; 720 where both are."""
    trail: float | None = None
    """Seconds of the ball's way that are shown."""
    show_bounces: bool = False
    """Show the last bounce of a frame in place of its end."""
    balls: int | None = None
    """Balls of a game (pinball, walls)."""
    nudge: bool = False
    """The table can be shoved (pinball)."""
    action: str | None = None
    """Kind of action: continuous or discrete (paddle), discrete or buttons (pinball)."""
    reward: str | None = None
    """Kind of reward, which the window does not show."""
    gamma: float | None = None
    """Discount of the dense reward (paddle, walls)."""
    frame_skip: int | None = None
    """Frames of 1/60 s for which a key acts. Default here: 1."""
    repeat_action_probability: float | None = None
    """Probability that a frame repeats the last action."""
    time_limit: float | None = None
    """Seconds of play; 0 for no limit."""
    num_levels: int | None = None
    """Levels that episodes are played on, 0 for all (paddle)."""
    start_level: int | None = None
    """The first of them."""
    obs: str | None = None
    """What an agent would be given: state or pixels."""
    obs_width: int | None = None
    """Of what an agent would be given, pixels."""
    obs_height: int | None = None
    """Of what an agent would be given, pixels."""
    grayscale: bool | None = None
    """Whether in grey."""

    def run(self) -> int:
        """Play; returns the exit code."""
        from bounce_env.commands.play import play_game  # noqa: PLC0415

        return play_game(self)


@dataclass(frozen=True)
class Watch:
    """Watch a trained agent play a game, in a window or as a film.

    P pauses, R begins the next episode, V starts and stops a film, Esc or Q quits.
    """

    game: Annotated[str, tyro.conf.Positional]
    """An id such as Bounce/Pinball-v0, or its short name: pinball."""
    seed: int = 10_000
    """Of the launches; agents are measured on those from 10000 on, and trained on others."""
    episodes: int | None = None
    """Stop after so many. Default: when you quit; 1 for a film."""
    film: Path | None = None
    """Write an .mp4 file instead of opening a window: for machines without a display."""
    films: Path = field(default_factory=Path)
    """Folder for films that V starts."""
    width: int | None = None
    """Of the field in pixels; left out it follows the scene's shape."""
    height: int | None = None
    """Of the field in pixels; left out it follows the scene's shape; 720 where both are."""
    trail: float = 0.25
    """Seconds of the ball's way that are shown."""
    agent: Path | None = None
    """An agent of your own: a .npz file that `python -m agents.export` has written. Default: the package's."""

    def run(self) -> int:
        """Watch; returns the exit code."""
        from bounce_env.commands.watch import watch_game  # noqa: PLC0415

        return watch_game(self)


@dataclass(frozen=True)
class Lab:
    """Try the engine out by hand, in a browser: a server on this machine, and a page.

    reflection: the tutorial's bounce, number by number. stage: a ball among walls that are dragged while it runs.
    play: the games, by keys, mouse or fingers.

    On a machine without a screen, forward the port, ssh -L 8765:localhost:8765 MACHINE, and open the address that is
    printed there.
    """

    room: Annotated[Literal["reflection", "stage", "play"] | None, tyro.conf.Positional] = None
    """What to open. Default: a page from which to choose."""
    scene: Annotated[str | None, tyro.conf.Positional] = None
    """Of the stage: path of a .toml file, or name of a built-in scene. Default: the tutorial's."""
    folder: Path = field(default_factory=Path)
    """Where scenes are read and saved."""
    host: str = "127.0.0.1"
    """Where to listen: other machines reach only another one than this."""
    port: int = 8765
    """Where to listen; 0: a free one."""
    open: bool = True
    """Open a browser."""
    benchmark: bool = False
    """Measure the stage in a browser without a window instead: needs Playwright and Chromium."""

    def run(self) -> int:
        """Serve until Ctrl-C, or measure; returns the exit code."""
        if self.benchmark:
            from bounce_env.commands.lab import run_benchmark  # noqa: PLC0415

            return run_benchmark()
        from bounce_env.commands.lab import run_lab  # noqa: PLC0415

        return run_lab(self.room, self.scene, folder=self.folder, host=self.host, port=self.port, show=self.open)


@dataclass(frozen=True)
class Replay:
    """Make a page of a replay that stands alone: of its document (.json), or anew of a page that an older version made.

    Environments make them: gym.make(..., record_events=True), and after an episode env.unwrapped.replay().save(FILE).
    """

    file: Annotated[Path, tyro.conf.Positional]
    """The .json or .html file."""
    output: Annotated[Path | None, tyro.conf.arg(aliases=["-o"])] = None
    """The page to write. Default: beside the file, with the ending .html."""
    show: bool = False
    """Open it in a browser."""

    def run(self) -> int:
        """Write the page; returns the exit code."""
        from bounce_env.commands.replay import write_page  # noqa: PLC0415

        return write_page(self.file, self.output, show=self.show)


@dataclass(frozen=True)
class Report:
    """Measure errors, stability, what features cost, and speed, beside other engines: a page, CSV, JSON and PNG.

    Everything is measured anew. Ctrl-C leaves an older report whole; --resume goes on from there. Other engines are
    those of the extra `report` that are installed. Exit code: 0 all is well, 1 --compare found worse errors.
    """

    part: Annotated[Literal["all", "error", "stability", "features", "speed"], tyro.conf.Positional] = "all"
    """What of it."""
    output: Annotated[Path, tyro.conf.arg(aliases=["-o"])] = Path("runs/report")
    """Folder to write to."""
    quick: bool = False
    """Few starts and settings: a minute, where kernels are on disk."""
    only: str = ""
    """Scenes and methods, separated by commas: --only box,pymunk,engine"""
    resume: bool = False
    """Go on with an interrupted run of the same options and sources."""
    compare: Path | None = None
    """An older report.json: exit code 1 where an error of this engine has become worse."""
    seed: int = 0
    """Of the starts."""

    def run(self) -> int:
        """Make the report; returns the exit code."""
        from bounce_env.commands.report import make_report  # noqa: PLC0415

        return make_report(
            self.part, output=self.output, quick=self.quick, only=self.only, resume=self.resume,
            compare=self.compare, seed=self.seed,
        )  # fmt: skip


@dataclass(frozen=True)
class Compile:
    """Compile kernels now, so that nobody waits later: of games, of scenes, or all that comes with the package.

    They are kept on disk; a game takes up to a minute, once on each machine and with each version.
    """

    names: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Games, built-in scenes and .toml files. Default: all, the games and the kernels that any scene can run on."""

    def run(self) -> int:
        """Compile; returns the exit code."""
        from bounce_env.commands.compile import compile_kernels  # noqa: PLC0415

        return compile_kernels(self.names)


@dataclass(frozen=True)
class Doctor:
    """Print versions, processor, cache folder, display and ffmpeg: what a bug report needs."""

    def run(self) -> int:
        """Print them; returns the exit code."""
        from bounce_env.commands.doctor import diagnose  # noqa: PLC0415

        return diagnose()


Command: TypeAlias = Scenes | Play | Watch | Lab | Replay | Report | Compile | Doctor
_Commands: TypeAlias = (
    Annotated[Watch, tyro.conf.subcommand("watch")]
    | Annotated[Play, tyro.conf.subcommand("play")]
    | Annotated[Scenes, tyro.conf.subcommand("scenes")]
    | Annotated[Lab, tyro.conf.subcommand("lab")]
    | Annotated[Replay, tyro.conf.subcommand("replay")]
    | Annotated[Report, tyro.conf.subcommand("report")]
    | Annotated[Compile, tyro.conf.subcommand("compile")]
    | Annotated[Doctor, tyro.conf.subcommand("doctor")]
)


def read(arguments: Sequence[str]) -> Command:
    """Return the command that the words give; for bad ones SystemExit with code 2, after a message."""
    command: Command = tyro.cli(
        _Commands,
        prog=program(),
        args=arguments,
        description="Games, agents and scenes of bounce_env. `bounce-env --version` prints the version.",
        config=(tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes),
    )
    return command

"""The scenes in the folder with which the lab was started: there it reads and writes, and nowhere else."""

import re
from pathlib import Path

from bounce_env.files import replacing
from bounce_env.lab.messages import NAME
from bounce_env.scene import Scene, dump_scene, load_scene


class Shelf:
    """Scenes by name: FOLDER/NAME.toml. Names are checked before they come here: letters, digits, _ and -."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def names(self) -> list[str]:
        """Return what can be loaded, sorted."""
        return sorted(
            path.stem
            for path in self.folder.glob("*.toml")
            if re.fullmatch(NAME, path.stem) and path.is_file() and not path.is_symlink()
        )

    def load(self, name: str) -> Scene:
        """Return a scene; raises SceneError, a ValueError, where there is none or it is wrong."""
        return load_scene(self.path(name))

    def save(self, name: str, scene: Scene, *, overwrite: bool) -> Path:
        """Write a scene whole; raises ValueError where one of that name is there, unless it may be overwritten."""
        path = self.path(name)
        if path.exists() and not overwrite:
            raise ValueError(f"{path.name} is there already: save it under another name, or overwrite it")
        try:
            with replacing(path) as unfinished:
                unfinished.write_text(dump_scene(scene), encoding="utf-8")
        except OSError as error:
            raise ValueError(f"{path.name}: cannot be written: {error.strerror}") from error
        return path

    def path(self, name: str) -> Path:
        """Return where a scene is, or would be; raises ValueError for a link."""
        path = self.folder / f"{name}.toml"
        if path.is_symlink():
            raise ValueError(f"{path.name}: is a link, which may lead out of the folder")
        return path

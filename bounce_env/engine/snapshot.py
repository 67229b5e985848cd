"""Snapshots: the full state of a world as bytes and back, bit for bit.

A header (magic word, version, digest of the scene), the arrays of the state one after the other, and a checksum. What
is not exactly that is refused whole. Nothing is unpickled.
"""

import hashlib
import struct

import numpy as np

from bounce_env.engine.memory.state import State, moving_arrays
from bounce_env.scene import Scene
from bounce_env.wording import shown

VERSION = 9
_MAGIC = b"bounce_env world"
_HEAD = struct.Struct("<16sI32s")
_CHECKSUM = 32


def snapshot_bytes(scene: Scene, state: State) -> bytes:
    """Return the state of a world of `scene`."""
    head = _HEAD.pack(_MAGIC, VERSION, _snapshot_digest(scene, state))
    data = head + b"".join(array.tobytes() for array in moving_arrays(state))
    return data + hashlib.sha256(data).digest()


def restore_bytes(data: bytes, scene: Scene, state: State) -> None:
    """Write a snapshot into the state of a world of `scene`, or raise ValueError before anything of it is written."""
    arrays = moving_arrays(state)
    size = _HEAD.size + sum(array.nbytes for array in arrays) + _CHECKSUM
    if not isinstance(data, bytes | bytearray | memoryview):
        raise ValueError(f"snapshot = {shown(data)}: must be bytes")
    data = bytes(data)
    if len(data) < _HEAD.size or not data.startswith(_MAGIC):
        raise ValueError(f"snapshot of {len(data)} bytes: is not one of a bounce_env World")
    _, version, digest = _HEAD.unpack_from(data)
    if version != VERSION:
        raise ValueError(f"snapshot of version {version}: must be of version {VERSION}")
    if digest != _snapshot_digest(scene, state):
        whose = "an equal one with the same features"
        raise ValueError(f"snapshot of another scene, or of other features: must be restored into a world of {whose}")
    if len(data) != size or hashlib.sha256(data[:-_CHECKSUM]).digest() != data[-_CHECKSUM:]:
        raise ValueError(f"snapshot of {len(data)} bytes: is truncated or changed, must be {size} bytes as written")
    offset = _HEAD.size
    for array in arrays:
        array[...] = np.frombuffer(data, array.dtype, array.size, offset).reshape(array.shape)
        offset += array.nbytes


def _snapshot_digest(scene: Scene, state: State) -> bytes:
    # The repr of a float has all its digits, and a scene is made of floats, names and flags.
    there = [name for name, array in zip(State._fields, state, strict=True) if array is not None]
    return hashlib.sha256(repr((scene, there)).encode()).digest()

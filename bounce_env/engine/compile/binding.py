"""How kernels get a named tuple of arrays: by the address of a block that says where the arrays are.

Numba passes a tuple by value, each number of each array in it an argument of its own, and counts references to every
array at every call, atomically. Of the state, a tuple of more than thirty arrays, two thirds of all code that LLVM gets
to read would be these arguments; a call from Python would read them all, too; and over a batch the counts would cost
more than the physics.

So address and shape of every array are written into one block of memory (`bind`), once, and everything compiled gets
the address of that. It reads what it names; nobody writes there as long as the block lives.
"""

import hashlib
import struct
from collections.abc import Iterator
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import types as nb_types
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import NativeValue, infer_getattr, lower_getattr_generic, register_model, unbox

_WORD = ir.IntType(64)
_BLOCK = ir.ArrayType(_WORD, 0).as_pointer()  # of words: numbers and addresses


class BoundType(nb_types.Type):
    """The type of a named tuple by its block; `fields`, `types` and `instance_class` are those of the tuple.

    of: Numba's type of the tuple. first_words: where in the block each member begins.
    """

    def __init__(self, of: Any) -> None:
        self.fields, self.types, self.instance_class = of.fields, of.types, of.instance_class
        self.first_words = [sum(map(_words_of, of.types[:i])) for i in range(len(of.types))]
        # Functions are named after the types of their arguments, and all of a tuple's would make most of their code.
        digest = hashlib.sha256(of.name.encode()).hexdigest()[:16]
        super().__init__(name=f"Bound{of.instance_class.__name__}{digest}")


class Bound:
    """A named tuple of arrays, named tuples of them, numbers and None, as kernels get it; the arrays live as long."""

    __slots__ = ("_numba_type_", "address", "block", "held")

    def __init__(self, held: Any) -> None:
        self.held = held
        self._numba_type_ = BoundType(numba.typeof(held))
        self.block = np.frombuffer(b"".join(_written(held)), np.int64)
        self.address = self.block.ctypes.data

    def __reduce__(self) -> tuple[Any, ...]:
        return bind, (self.held,)  # elsewhere its arrays are elsewhere


def bind(held: Any) -> Any:
    """Return a named tuple as kernels get it: `Bound`, or the tuple itself where nothing is compiled.

    Raises TypeError where it has other members than arrays, tuples, integers, floats, booleans and None.
    """
    return held if numba.config.DISABLE_JIT else Bound(held)


def _written(value: Any) -> Iterator[bytes]:
    """Write a value as `_read` reads it."""
    if isinstance(value, tuple):
        for member in value:
            yield from _written(member)
    elif isinstance(value, np.ndarray):
        yield struct.pack(f"q{2 * value.ndim}q", value.ctypes.data, *value.shape, *value.strides)
    elif isinstance(value, float):
        yield struct.pack("d", value)
    elif isinstance(value, int | np.int64 | np.bool_):
        yield struct.pack("q", value)
    elif value is not None:
        raise TypeError(f"{value!r} cannot be bound: must be an array, a tuple, an int, a float, a bool or None")


def _words_of(kind: Any) -> int:
    if isinstance(kind, nb_types.Array):
        return 1 + 2 * kind.ndim
    if isinstance(kind, nb_types.BaseTuple):  # type: ignore[attr-defined]
        return sum(map(_words_of, kind.types))
    return 0 if kind == nb_types.none else 1


@register_model(BoundType)
class _BlockModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: BoundType) -> None:
        super().__init__(manager, kind, _BLOCK)


@unbox(BoundType)  # type: ignore[untyped-decorator]
def _unbox(kind: BoundType, value: Any, c: Any) -> Any:
    address = c.pyapi.object_getattr_string(value, "address")
    number = c.pyapi.long_as_longlong(address)
    c.pyapi.decref(address)
    return NativeValue(c.builder.inttoptr(number, _BLOCK), is_error=c.pyapi.c_api_error())


@infer_getattr
class _Members(AttributeTemplate):  # type: ignore[misc]
    key = BoundType

    def generic_resolve(self, bound: BoundType, name: str) -> Any:
        if name not in bound.fields:
            return None
        member = bound.types[bound.fields.index(name)]
        named = isinstance(member, nb_types.BaseNamedTuple)  # type: ignore[attr-defined]
        return BoundType(member) if named else member


@lower_getattr_generic(BoundType)  # type: ignore[untyped-decorator]
def _read_member(context: Any, builder: Any, bound: BoundType, block: Any, name: str) -> Any:
    index = bound.fields.index(name)
    return _read(context, builder, bound.types[index], block, bound.first_words[index])


def _place(builder: Any, block: Any, word: int, kind: Any) -> Any:
    """Return the address of a word of the block, where a value of LLVM's type `kind` is."""
    start = builder.gep(block, [ir.Constant(_WORD, 0), ir.Constant(_WORD, word)], inbounds=True)
    return start if kind == _WORD else builder.bitcast(start, kind.as_pointer())


def _load(builder: Any, block: Any, word: int, kind: Any) -> Any:
    """Read a word, of which LLVM is told that nobody ever writes it."""
    value = builder.load(_place(builder, block, word, kind))
    value.set_metadata("invariant.load", builder.module.add_metadata([]))
    return value


def _read(context: Any, builder: Any, kind: Any, block: Any, word: int) -> Any:
    """Read a value of the block, from a word on; of a named tuple its part of the block."""
    if isinstance(kind, nb_types.BaseNamedTuple):  # type: ignore[attr-defined]
        return builder.bitcast(_place(builder, block, word, _WORD), _BLOCK)
    if isinstance(kind, nb_types.BaseTuple):  # type: ignore[attr-defined]
        members = []
        for member in kind.types:
            members.append(_read(context, builder, member, block, word))
            word += _words_of(member)
        return context.make_tuple(builder, kind, members)
    if isinstance(kind, nb_types.Array):
        return _read_array(context, builder, kind, block, word)
    if kind == nb_types.none:
        return context.get_dummy_value()
    if kind == nb_types.boolean:
        return builder.trunc(_load(builder, block, word, _WORD), ir.IntType(1))
    return _load(builder, block, word, context.get_value_type(kind))


def _read_array(context: Any, builder: Any, kind: Any, block: Any, word: int) -> Any:
    """Read an array that says of no owner, so that nobody counts references to it."""
    numbers = [_load(builder, block, word + 1 + i, _WORD) for i in range(2 * kind.ndim)]
    shape, strides = numbers[: kind.ndim], numbers[kind.ndim :]
    itemsize = ir.Constant(_WORD, context.get_abi_sizeof(context.get_data_type(kind.dtype)))
    if kind.layout == "C":
        strides[-1] = itemsize
    items = shape[0]
    for length in shape[1:]:
        items = builder.mul(items, length)
    layout = context.get_value_type(kind)  # see numba.core.datamodel.models.ArrayModel
    data = _load(builder, block, word, layout.elements[4])
    array = ir.Constant(layout, [None, None, ir.Undefined, itemsize, ir.Undefined, ir.Undefined, ir.Undefined])
    members: list[tuple[Any, tuple[int, ...]]] = [(items, (2,)), (data, (4,))]
    members += [(length, (5, i)) for i, length in enumerate(shape)]
    members += [(stride, (6, i)) for i, stride in enumerate(strides)]
    for value, path in members:
        array = builder.insert_value(array, value, path)
    return array

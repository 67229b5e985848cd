"""How a function is compiled that only other compiled functions call: to LLVM's language, and no further.

Numba links every function with all that it calls, optimises that, and makes machine code of it, before it does so
again for what calls it. A kernel of a hundred functions that lie ten calls deep is thus optimised ten times over, for
code that nobody runs, and as many copies of it stay in memory. Here these steps are left to the kernel: it compiles
several times faster, to the same instructions.
"""

from typing import Any

from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, PassManager, register_pass
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.untyped_passes import (
    DeadBranchPrune,
    FixupArgs,
    GenericRewrites,
    InlineInlinables,
    IRProcessing,
    ReconstructSSA,
    RewriteSemanticConstants,
    TranslateByteCode,
)


class _Library(JITCodeLibrary):  # type: ignore[misc]
    """Code of one function, neither linked with what it calls, nor optimised, nor run by itself."""

    def finalize(self) -> None:
        """Make it fit for being linked into kernels."""
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = "linkonce_odr"
        self._finalize_dynamic_globals()
        self._shared_module, self._finalized = self._final_module, True


class _KernelLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code that is optimised with all that it calls, of which nothing else needs to be seen from outside."""

    _linking_libraries: list[Any]

    def finalize(self) -> None:
        """Link what is called, however deep, once; optimise all, and make machine code of it."""
        found: list[Any] = []
        for library in self._linking_libraries:
            _find_callees_first(library, found)
        # LLVM leaves out what nothing that is there calls, so that callers have to come first.
        self._linking_libraries = found[::-1]
        super().finalize()

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.linkonce_odr:
                function.linkage = "internal"
        super()._optimize_final_module()


def _find_callees_first(library: Any, found: list[Any]) -> None:
    """Append to `found` the libraries that a library calls, then itself."""
    if library in found:
        return
    for called in library._linking_libraries if isinstance(library, _Library) else ():
        _find_callees_first(called, found)
    found.append(library)


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(LoweringPass):  # type: ignore[misc]
    """Numba's lowering, into a library of that kind."""

    _name = "bounce_env_inner_lowering"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = _Library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        state.flags.no_compile = True
        NativeLowering().run_pass(state)
        # Callers know a function by its entry point, of which there is none here. Numba asks for a builtin one: each of
        # these is another object, and raises when Python calls it.
        entry: Any = ["compiled for kernels only: see from_python"].index
        lowered = state["cr"]
        state.targetctx.insert_user_function(entry, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class _KernelLowering(LoweringPass):  # type: ignore[misc]
    """Numba's lowering, into a library of the other kind."""

    _name = "bounce_env_kernel_lowering"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = _KernelLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(NativeLowering().run_pass(state))


# Numba's passes without those for what our functions do not have: closures, comprehensions, `with`, `raise` of what is
# not constant, arithmetic of whole arrays. Each would cost as much as one that finds something.
_INNER_PASSES = (
    TranslateByteCode, FixupArgs, IRProcessing, RewriteSemanticConstants, DeadBranchPrune, GenericRewrites,
    InlineInlinables, ReconstructSSA, DeadBranchPrune, NopythonTypeInference, PreLowerStripPhis, IRLegalization,
    _InnerLowering, NoPythonBackend,
)  # fmt: skip


class InnerCompiler(CompilerBase):  # type: ignore[misc]
    """Numba's pipeline for what only kernels call."""

    def define_pipelines(self) -> list[Any]:
        """See numba.core.compiler."""
        manager = PassManager("bounce_env_inner")
        for step in _INNER_PASSES:
            manager.add_pass(step, step.__name__)
        manager.finalize()
        return [manager]


class KernelCompiler(CompilerBase):  # type: ignore[misc]
    """Numba's pipeline for kernels."""

    def define_pipelines(self) -> list[Any]:
        """See numba.core.compiler."""
        return [_with_lowering(self.state, _KernelLowering)]


def _with_lowering(state: Any, lowering: type[LoweringPass]) -> Any:
    pipeline = DefaultPassBuilder.define_nopython_pipeline(state, lowering._name)
    pipeline._finalized = False
    pipeline.passes = [(lowering if step is NativeLowering else step, name) for step, name in pipeline.passes]
    pipeline.finalize()
    return pipeline

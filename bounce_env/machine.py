"""What machine this is, for those who report what it did."""

import platform


def processor() -> str:
    """Return the processor's kind, and the name under which LLVM makes code for it."""
    import llvmlite.binding  # noqa: PLC0415 (only what is asked for is imported)

    return f"{platform.machine()}, {llvmlite.binding.get_host_cpu_name()}"

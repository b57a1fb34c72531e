"""`python -m benchmarks.service.pinned CORE MODULE [ARGUMENTS]`: run a module on one core of the machine alone."""

import os
import runpy
import sys


def pin(core: int) -> bool:
    """Stay on this core; False on a machine that has no such core, or cannot be asked."""
    if not hasattr(os, "sched_setaffinity") or core not in os.sched_getaffinity(0):
        return False
    os.sched_setaffinity(0, {core})
    return True


if __name__ == "__main__":
    core, module, *arguments = sys.argv[1:]
    pin(int(core))
    sys.argv = [module, *arguments]
    runpy.run_module(module, run_name="__main__", alter_sys=True)

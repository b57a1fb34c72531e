"""Live diagnostics: senses and thoughts, sent while a technician watches.

May use the mind and the drive loop.
Start at `service.py`.
"""

from robot.ops.diagnostics.service import DiagnosticsReporter

__all__ = ["DiagnosticsReporter"]

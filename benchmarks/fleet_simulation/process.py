"""A process that does nothing but simulate."""

import gc
import logging

import structlog


def simulates_only() -> None:
    """Call it where such a process begins: no log lines, and the collector looks rarely, which saves a tenth."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)

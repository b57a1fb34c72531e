"""Replays of scenarios: recordings, drawings, pictures, a page.

May use the stage.
Start at `recording.py`.
"""

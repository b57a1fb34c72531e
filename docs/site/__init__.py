"""Build the documentation site: `python -m docs.site` (`make docs`).

May use every package of ours, to read what the reference pages list. Start at `__main__.py`.
"""

"""HTTP of the whole service: middleware, pages, API document, metrics, and what it says of itself.

Features do not import it, but for `marker_sheets` and `request_metrics` nothing here knows one.
Start at `api_document.py` and `pages.py`.
"""

"""Orders over HTTP: place, list, follow, change; standing orders.

Handlers of a few lines; the work is in `app.orders`.
Start at `orders.py`.
"""

"""Tables of orders: events, links, hand-overs, delegates, standing orders.

Imported through `app.models`.
Start at `orders.py`.
"""

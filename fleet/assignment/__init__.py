"""Assignment of orders to robots: a first answer at once, better ones while there is time.

May use `fleet.schedule`.
Start at `deciding.py`, then `improving.py`.
"""

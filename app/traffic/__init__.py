"""Traffic: answers reservation requests, closes corridors, takes robots out of service.

Between the robots' links, the database and `fleet.schedule`.
Start at `service.py`.
"""

"""ETA: durations, forecasts of plans, calibrated intervals and scores.

May use `fleet.schedule`.
Start at `arrivals.py` and `forecast.py`.
"""

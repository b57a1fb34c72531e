"""Chain of custody: hand-over codes, who had the mail, and claims without proof.

Only reports of robots write custody.
Start at `custody.py`.
"""

"""Camera and markers: frames, QR codes, AprilTags, pose.

Imports no other driver but `interfaces`.
Start at `marker_reader.py`.
"""

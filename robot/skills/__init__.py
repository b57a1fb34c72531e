"""The long actions of the body. What they are: interfaces.py. Reasons of failure beside each.

FollowLine(campus, leaving=None, cruise_mm_s=150.0, shape=BodyShape())
                                Done(post reached) | line_lost, blocked, timeout
Turn(angle_rad, shape=…)        left is positive; by encoders, then settles on the line. Done() | timeout
FindLine(shape=…)               Done() | line_lost
Dock(tries=3)                   Done() | no_dock
Undock(shape=…)                 Done() | not_docked, timeout; ends on the line, looking along it
WaitHandover(verifiers: frozenset[str], limit_s)
                                Done(sha256 that matched) | Done(None) after Spot twice | no_one_came
Say(notes=TUNES["arrived"], colour=0.0, brightness=1.0)    Done()
DrivePulse(forward|left|right|stop|spiral)                 Done() at once; the wheels go on for 0.2 s
PaperTurn(angle_rad)            done when the line is centred. Done() | timeout after 10 s
"""

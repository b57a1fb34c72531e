"""Rules of charging that were tried beside the product's and not taken."""

from fleet.charging.acceptance import Charge
from fleet.charging.docks import DockPlan
from fleet.charging.energy import Use
from fleet.charging.levels import Thresholds


def passes_dock(charge: Charge, to_next: Use, thresholds: Thresholds) -> bool:
    """Tell if a robot whose work is more than one charge may pass a dock that is free. `to_next`: its next stop, and
    from there to a dock. Else it charges here: later it would break off with little left, and the dock that it comes
    to then may be another's."""
    return charge.ratio >= min(thresholds.full - thresholds.hysteresis, thresholds.low + charge.rates.at_most(to_next))


def is_no_worse(plan: DockPlan, other: DockPlan) -> bool:
    """So that one robot's trouble, which no refusal would mend, does not keep all others from work."""
    return plan.late_s <= other.late_s + 1.0 and len(plan.homeless) <= len(other.homeless)

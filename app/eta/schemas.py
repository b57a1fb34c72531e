"""Accuracy of estimates, over HTTP."""

from typing import Literal, cast

from pydantic import BaseModel

from fleet.eta.arrivals import Estimates
from fleet.eta.calibration import Basis
from fleet.eta.durations import Kind, Thing
from fleet.eta.intervals import HIGH, LOW, MIDDLE
from fleet.eta.score import Score

Seen = Literal["corridor", "load", "receive"]


class EstimateError(BaseModel):
    """One way to estimate. `median_error_ratio`: of the middle, as a share of what it took. `pinball_s`: the mean loss
    of the three quantiles, in seconds; less is better."""

    median_error_ratio: float
    pinball_s: float


class DurationView(BaseModel):
    """The duration of one thing: quantiles in seconds, of which `seen` were seen; `assumed_s` by map and settings."""

    kind: Seen
    name: str
    from_post: str | None
    to_post: str | None
    seen: int
    assumed_s: float
    p10_s: float
    p50_s: float
    p90_s: float


class PromiseQuality(BaseModel):
    """The accuracy of the arrivals of the latest orders, `scored` in number.

    `inside_ratio` is how often the robot came between the times that were told, `earlier_ratio` and `later_ratio` how
    often before and after them. `by_map`: what the lengths on the map alone would have told of the same orders. All of
    it is null as long as no robot has come.
    """

    scored: int
    inside_ratio: float | None
    earlier_ratio: float | None
    later_ratio: float | None
    told: EstimateError | None
    by_map: EstimateError | None

    @classmethod
    def of(cls, score: Score | None) -> "PromiseQuality":
        if score is None:
            return cls(scored=0, inside_ratio=None, earlier_ratio=None, later_ratio=None, told=None, by_map=None)
        by_map = EstimateError(median_error_ratio=score.median_error_by_map, pinball_s=score.pinball_by_map_s)
        return cls(
            scored=score.count,
            inside_ratio=score.inside,
            earlier_ratio=score.below,
            later_ratio=score.above,
            told=EstimateError(median_error_ratio=score.median_error, pinball_s=score.pinball_s),
            by_map=by_map,
        )


class EstimateQuality(BaseModel):
    """The accuracy of estimated arrivals: `placed`, as told when an order was placed; `under_way`, as told first when a
    robot had it and first after its mail was loaded, so up to twice for each order.

    `assumed`: people are still told what the lengths on the map say, since too little was seen. `inside_meant` is aimed
    at as `inside_ratio`.
    """

    assumed: bool
    inside_meant: float
    placed: PromiseQuality
    under_way: PromiseQuality
    durations: list[DurationView]

    @classmethod
    def of(cls, estimates: Estimates) -> "EstimateQuality":
        """As it is now; of all things that were ever seen, corridors first."""
        return cls(
            assumed=estimates.is_assumed,
            inside_meant=round(HIGH - LOW, 2),
            placed=PromiseQuality.of(estimates.told[Basis.PLACED].score()),
            under_way=PromiseQuality.of(estimates.told[Basis.UNDER_WAY].score()),
            durations=[_view(estimates, thing) for thing in estimates.things()],
        )


def _view(estimates: Estimates, thing: Thing) -> DurationView:
    posts = thing.name.split(" ") if thing.kind is Kind.CORRIDOR else [None, None]
    p10_s, p50_s, p90_s = (estimates.durations.quantile_s(thing, share) for share in (LOW, MIDDLE, HIGH))
    return DurationView(
        kind=cast(Seen, thing.kind.value),
        name=thing.name,
        from_post=posts[0],
        to_post=posts[1],
        seen=estimates.durations.seen(thing.kind, thing.name),
        assumed_s=thing.assumed_s,
        p10_s=p10_s,
        p50_s=p50_s,
        p90_s=p90_s,
    )

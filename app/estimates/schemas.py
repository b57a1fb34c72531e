"""How good estimates are, over HTTP."""

from typing import Literal, cast

from pydantic import BaseModel

from app.estimates.arrivals import Estimates
from app.estimates.durations import Kind, Thing
from app.estimates.intervals import HIGH, LOW, MIDDLE
from app.estimates.score import Score

Seen = Literal["corridor", "load", "receive"]


class EstimateError(BaseModel):
    """One way to estimate. `median_error_ratio`: of the middle, as a share of what it took. `pinball_s`: the mean loss
    of the three quantiles, in seconds; less is better."""

    median_error_ratio: float
    pinball_s: float


class DurationView(BaseModel):
    """How long one thing takes: quantiles in seconds, of which `seen` were seen; `assumed_s` by map and settings."""

    kind: Seen
    name: str
    from_post: str | None
    to_post: str | None
    seen: int
    assumed_s: float
    p10_s: float
    p50_s: float
    p90_s: float


class EstimateQuality(BaseModel):
    """How good arrivals were estimated of the latest orders, `scored` in number.

    `assumed`: people are still told what the lengths on the map say, since too little was seen. `inside_ratio` is how
    often the robot came between the times that were told (`inside_meant` is aimed at), `earlier_ratio` and
    `later_ratio` how often before and after them. `by_map`: what the lengths alone would have told of the same orders.
    All of it is null as long as no robot has come.
    """

    scored: int
    assumed: bool
    inside_meant: float
    inside_ratio: float | None
    earlier_ratio: float | None
    later_ratio: float | None
    told: EstimateError | None
    by_map: EstimateError | None
    durations: list[DurationView]

    @classmethod
    def of(cls, estimates: Estimates) -> "EstimateQuality":
        """As it is now; of all things that were ever seen, corridors first."""
        score = estimates.score()
        return cls(
            scored=score.count if score else 0,
            assumed=estimates.is_assumed,
            inside_meant=round(HIGH - LOW, 2),
            inside_ratio=score.inside if score else None,
            earlier_ratio=score.below if score else None,
            later_ratio=score.above if score else None,
            told=_told(score),
            by_map=_by_map(score),
            durations=[_view(estimates, thing) for thing in estimates.things()],
        )


def _told(score: Score | None) -> EstimateError | None:
    return None if score is None else EstimateError(median_error_ratio=score.median_error, pinball_s=score.pinball_s)


def _by_map(score: Score | None) -> EstimateError | None:
    if score is None:
        return None
    return EstimateError(median_error_ratio=score.median_error_by_map, pinball_s=score.pinball_by_map_s)


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

"""What electronics and firmware smooth: digital ones, where the catalogue's are continuous.

A class of its own, so that the cases of the other classes stay what they are.
"""
from axis_effect import Effect


def _filter(id, size, hide, parameter="time_constant_s", **more):
    return Effect(
        id,
        size,
        hide=lambda m, s, r: hide(m),
        oracle=lambda m, s, r: {parameter: m},
        equal_law=(parameter,),
        **{"shows": ("chirp", "prbs", "steps"), **more},
    )


ROW_BY_ROW_S = (2e-3, 0.05)  # from two rows on: smoothing row by row is no low pass of a shorter time

FILTERS = [
    _filter("command_low_pass", (2e-4, 0.05), lambda m: {"smooth_s": m}),
    _filter(
        "command_rate_limit",
        (0.005, 2.0),
        lambda m: {"most_duty_per_s": 1 / m},
        parameter="inverse_rate_s",
        shows=("prbs", "steps", "hard"),
    ),
    # a speed that is reported, and no encoder beside it
    _filter("speed_low_pass", ROW_BY_ROW_S, lambda m: {"speed_filter_s": m}, needs=("hall", "current")),
    _filter("current_low_pass", ROW_BY_ROW_S, lambda m: {"current_filter_s": m}, needs=("current",)),
]

"""The list of cases of a set: which class, what is hidden, in which order.

A set is "dev" (open: develop against it), "release" (scored once per release) or "sealed" (never looked at before the
closing score). The sets differ in nothing but the source of their random numbers. Within a class the order goes round
all effects, so that the first N cases of a class are spread as widely as N allows.
"""
import dataclasses
import hashlib

import robot_effects
from axis_effects import BY_ID, EFFECTS
from axis_filters import FILTERS
from share import spread_share

SETS = ("dev", "release", "sealed")


@dataclasses.dataclass(frozen=True)
class Case:
    set: str
    cls: str
    index: int
    what: tuple  # what is hidden: ids of effects, or the name of a fault or of something no list has

    @property
    def key(self):
        return (self.set, self.cls, self.index)

    @property
    def name(self):
        """A folder name that says nothing."""
        return hashlib.sha256("/".join(["name", *map(str, self.key)]).encode()).hexdigest()[:10]


def _pairs():
    """Pairs that can sit on one bench, in a fixed order that mixes them."""
    out = []
    drives = [e for e in EFFECTS if "drive" in e.rigs]
    for a in drives:
        for b in drives:
            if a.id < b.id and _together(a, b):
                out.append((a.id, b.id))
    return sorted(out, key=lambda pair: hashlib.sha256("/".join(pair).encode()).hexdigest())


def _together(a, b):
    both = set(a.needs) | set(b.needs)
    if {"heating", "not heated"} <= both or {"hall", "two speeds"} <= both or {"hall", "encoder"} <= both:
        return False
    if b.id in a.same or a.id in b.same or {a.id, b.id} <= {"gravity_load", "imbalance"}:
        return False
    alike = (
        {"backlash", "shaft_compliance"},
        {"current_limit", "thermal_derating"},
        {"stribeck_friction", "lugre_friction"},
        {"coulomb_friction", "stribeck_friction"},
        {"coulomb_friction", "lugre_friction"},
        {"coulomb_friction", "friction_asymmetry"},
        {"actuator_delay", "sampling_delay"},
        {"hall_speed_estimator", "sample_jitter"},
    )
    return {a.id, b.id} not in alike


def _shares(case):
    import axis_case

    return spread_share(
        axis_case.source("share", *case.key), case.index
    )  # 33 effects: each meets all of the 8 shares


def _single(case, folder, share, **options):
    import axis_case

    return axis_case.make_effects_case(folder, case.key, case.what, share, **options)


def _around(n, count):
    ids = [e.id for e in EFFECTS]
    return [(ids[k % len(ids)],) for k in range(count or n * len(ids))]


def _loop_effects(count):
    open_only = {"target_speed_limit", "duty_limit", "hall_speed_estimator", "sample_jitter"}
    ids = [e.id for e in EFFECTS if e.id not in open_only and "drive" in e.rigs]
    return [(ids[(7 * k) % len(ids)],) for k in range(count)]


def _robot_share(case):
    import axis_case

    return spread_share(
        axis_case.source("share", *case.key), case.index + case.index // len(robot_effects.EFFECTS)
    )


@dataclasses.dataclass(frozen=True)
class Class:
    title: str
    cases: list  # what is hidden, case by case
    make: callable  # (case, folder) -> answer


def classes():
    import axis_case
    import faults
    import outside
    import radio_case
    import robot_case
    import torque_case

    strange, broken = outside.names(), list(faults.KINDS)
    bots = [e.id for e in robot_effects.EFFECTS]
    return {
        "single": Class(
            "one hidden effect, recommended excitation", _around(8, 0), lambda c, f: _single(c, f, _shares(c))
        ),
        "generic": Class(
            "one hidden effect, mixed excitation",
            _around(3, 0),
            lambda c, f: _single(c, f, _shares(c), generic=True),
        ),
        "control": Class("no hidden effect", [()] * 150, lambda c, f: axis_case.make_control_case(f, c.key)),
        "pair": Class("two hidden effects", _pairs()[:60], lambda c, f: _single(c, f, 0.5)),
        "faint": Class(
            "one effect below what can be seen",
            _around(1, 0)[::2] + _around(1, 0)[1:16:2],
            lambda c, f: _single(c, f, 5e-5),
        ),
        "filter": Class(
            "one low pass or ramp of electronics or firmware",
            [(FILTERS[k % len(FILTERS)].id,) for k in range(8 * len(FILTERS))],
            lambda c, f: _single(c, f, _shares(c)),
        ),
        "loop": Class(
            "closed-loop record, one hidden effect",
            _loop_effects(24),
            lambda c, f: _single(c, f, 0.5, closed_loop=True),
        ),
        "loop-control": Class(
            "closed-loop record, no hidden effect",
            [()] * 12,
            lambda c, f: axis_case.make_control_case(f, c.key, closed_loop=True),
        ),
        "torque": Class(
            "torque-driven record, one hidden effect",
            [(torque_case.IDS[k % len(torque_case.IDS)],) for k in range(4 * len(torque_case.IDS))],
            lambda c, f: torque_case.make_case(f, c.key, c.what, _shares(c)),
        ),
        "torque-control": Class(
            "torque-driven record, no hidden effect",
            [()] * 24,
            lambda c, f: torque_case.make_case(f, c.key, (), 0),
        ),
        "outside": Class(
            "something no list of effects has",
            [(strange[k % len(strange)],) for k in range(50)],
            lambda c, f: outside.make_case(f, c.key, c.what[0]),
        ),
        "beside": Class(
            "one hidden effect beside something no list of effects has",
            outside.with_an_effect(),
            lambda c, f: outside.make_case_with_an_effect(f, c.key, *c.what),
        ),
        "fault": Class(
            "broken record",
            [(broken[k % len(broken)],) for k in range(42)],
            lambda c, f: faults.make_case(f, c.key, c.what[0]),
        ),
        "robot": Class(
            "robot, one hidden effect",
            [(bots[k % len(bots)],) for k in range(5 * len(bots))],
            lambda c, f: robot_case.make_case(f, c.key, c.what, _robot_share(c)),
        ),
        "robot-control": Class(
            "robot, no hidden effect", [()] * 24, lambda c, f: robot_case.make_case(f, c.key, (), 0)
        ),
        "radio": Class(
            "robot by radio, one hidden effect",
            [(radio_case.IDS[k % len(radio_case.IDS)],) for k in range(4 * len(radio_case.IDS))],
            lambda c, f: radio_case.make_case(f, c.key, c.what, _robot_share(c)),
        ),
        "radio-control": Class(
            "robot by radio, no hidden effect", [()] * 24, lambda c, f: radio_case.make_case(f, c.key, (), 0)
        ),
    }


# A few of each class of the open set, sizes well above the limit: what every run of the tests does in minutes.
REDUCED = {
    "single": (6, 7, 12, 15),
    "generic": (12,),
    "control": (0, 1, 3),
    "pair": (0,),
    "outside": (1,),
    "fault": (1,),
    "robot": (9,),
}


def reduced():
    """The cases of the reduced run."""
    table = classes()
    return [Case("dev", name, k, table[name].cases[k]) for name, chosen in REDUCED.items() for k in chosen]


def list_cases(set_name, only=None, count=None, skip=0):
    """Cases of a set: of the named classes, the first `count` of each but for the first `skip`; class by class in turn, so
    that a run that is cut off has seen of each."""
    out = []
    for name, cls in classes().items():
        if only and name not in only:
            continue
        out += [Case(set_name, name, k, what) for k, what in enumerate(cls.cases[:count])]
    return sorted((case for case in out if case.index >= skip), key=lambda case: case.index)


def make(case, folder):
    """Writes the case's folder and returns its answer."""
    answer = classes()[case.cls].make(case, folder)
    return {
        "case": case.name,
        "set": case.set,
        "class": case.cls,
        "index": case.index,
        "what": list(case.what),
        **answer,
    }


assert all(e in BY_ID for pair in _pairs() for e in pair)

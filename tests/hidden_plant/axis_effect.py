"""What an effect of the hidden axis is made of."""
import dataclasses
from typing import Callable


@dataclasses.dataclass(frozen=True)
class Effect:
    id: str
    size: tuple  # least and largest size
    hide: Callable  # (size, shape, rig) -> plant parameters
    oracle: Callable  # (size, shape, rig) -> parameters of the catalogue's law
    shows: tuple  # excitations that reveal it
    shape: Callable = lambda rng, rig: {}
    equal_law: tuple = ()  # oracle parameters that mean the same in both laws
    needs: tuple = ()  # of the rig
    gears: tuple = ()
    rigs: tuple = ("drive",)
    scale: str = ""  # "torque": sizes are times the rig's friction scale; "stall": per stall current
    same: tuple = ()  # ids whose law is this one's, to first order, in every record of an axis

"""The compiled hidden plants, called from Python: parameters by name, columns back as arrays of doubles."""
import array
import ctypes
import os
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
RAW = ("command", "bus", "current", "angle", "speed", "out_angle", "out_speed", "winding_K")
SEEN = ("counts", "bus", "current", "speed", "angle")
BOT = (
    "bus",
    *(f"current_{k}" for k in range(1, 7)),
    *(f"counts_{k}" for k in range(1, 7)),
    "gyro",
    "ax",
    "ay",
    "cam_x",
    "cam_y",
    "cam_turn",
    "x",
    "y",
    "turn",
    *(f"speed_{k}" for k in range(1, 5)),
)
SUMS = ("in_J", "lost_J", "stored_J")


def library_path():
    """The library CMake built (HIDDEN_PLANT_LIBRARY), else one compiled here beside the caller's cache."""
    if "HIDDEN_PLANT_LIBRARY" in os.environ:
        return pathlib.Path(os.environ["HIDDEN_PLANT_LIBRARY"])
    built = pathlib.Path(os.environ.get("TMPDIR", "/tmp")) / f"hidden_plant_{os.getuid()}.so"
    sources = sorted(HERE.glob("*.c"))
    newest = max(path.stat().st_mtime for path in [*sources, *HERE.glob("*.h")])
    if not built.exists() or built.stat().st_mtime < newest:
        fresh = built.with_suffix(f".{os.getpid()}")
        subprocess.run(
            [
                "cc",
                "-std=c11",
                "-D_GNU_SOURCE",
                "-O2",
                "-ffp-contract=off",
                "-fPIC",
                "-shared",
                "-o",
                str(fresh),
                *map(str, sources),
                "-lm",
            ],
            check=True,
        )
        fresh.replace(built)
    return built


_lib = ctypes.CDLL(str(library_path()))


def _doubles(n):
    return array.array("d", bytes(8 * n))


def _pointer(values):
    return (ctypes.c_double * len(values)).from_buffer(values)


class Plant:
    """One of the plants in the library; `name` is the prefix of its functions."""

    def __init__(self, name):
        name_of = getattr(_lib, f"{name}_param_name")
        value_of = getattr(_lib, f"{name}_param_value")
        name_of.restype = ctypes.c_char_p
        value_of.restype = ctypes.c_double
        count = getattr(_lib, f"{name}_param_count")()
        self.defaults = {name_of(k).decode(): value_of(k) for k in range(count)}

    def pack(self, params):
        unknown = set(params) - set(self.defaults)
        if unknown:
            raise KeyError(f"no such plant parameter: {sorted(unknown)}")
        return _pointer(array.array("d", [float(params.get(k, v)) for k, v in self.defaults.items()]))


class Columns(dict):
    """Named columns, all of one length."""

    @classmethod
    def split(cls, flat, names):
        return cls({name: flat[k :: len(names)] for k, name in enumerate(names)})


AXIS = Plant("axis")
ROBOT = Plant("robot")


def run_axis(params, asked):
    """Simulates one record. Returns (raw table, sums); raise when the state stopped being finite."""
    n = len(asked)
    raw, sums = _doubles(n * len(RAW)), _doubles(len(SUMS))
    failed = _lib.axis_run(
        AXIS.pack(params), _pointer(array.array("d", asked)), n, _pointer(raw), _pointer(sums)
    )
    if failed:
        raise ArithmeticError("the hidden axis stopped being finite")
    return raw, dict(zip(SUMS, sums))


def sense_axis(params, raw, seed):
    """What the sensors of the axis show of a raw table."""
    n = len(raw) // len(RAW)
    seen = _doubles(n * len(SEEN))
    _lib.axis_sense(AXIS.pack(params), _pointer(raw), n, ctypes.c_double(seed), _pointer(seen))
    return Columns.split(seen, SEEN)


def raw_columns(raw):
    return Columns.split(raw, RAW)


def _row(row):
    return [*row[:-1], *[0.0] * (7 - len(row)), row[-1]]


def run_robot(params, asked, change=None):
    """`asked`: rows of a duty for each wheel (at least four numbers) and the dribbler's speed. Returns the columns of BOT; NaN where a camera cell is empty.

    `change`: (row, parameters) from which on it is another robot in the same state."""
    n = len(asked)
    flat, out = array.array("d", [x for row in asked for x in _row(row)]), _doubles(n * len(BOT))
    row, then = (change[0], ROBOT.pack(change[1])) if change else (0, None)
    if _lib.robot_run_changed(ROBOT.pack(params), then, row, _pointer(flat), n, _pointer(out)):
        raise ArithmeticError("the hidden robot stopped being finite")
    return Columns.split(out, BOT)


class LiveAxis:
    """The hidden axis row by row: `row(how, asked)` goes on by sample_s; `raw` is the table's row at its beginning."""

    OFF, DUTY, VOLTAGE, CURRENT = range(4)

    def __init__(self, params):
        _lib.axis_open.restype = ctypes.c_void_p
        self._packed = AXIS.pack(params)
        self._axis = ctypes.c_void_p(_lib.axis_open(self._packed))
        self.raw = _doubles(len(RAW))
        self._out, self._seen = _pointer(self.raw), _doubles(len(SEEN))
        self._seen_out = _pointer(self._seen)
        self.rows = 0

    def row(self, how, asked):
        if _lib.axis_row(self._axis, how, ctypes.c_double(asked), self._out):
            raise ArithmeticError("the hidden axis stopped being finite")
        self.rows += 1

    def look(self):
        """`raw` as it is now: what is asked from here on has not acted yet."""
        _lib.axis_look(self._axis, self._out)

    def seen(self):
        """What the sensors make of `raw`."""
        _lib.axis_sense(self._packed, self._out, 1, ctypes.c_double(self.rows), self._seen_out)
        return dict(zip(SEEN, self._seen))

    def close(self):
        _lib.axis_close(self._axis)


class LiveRobot:
    """The hidden robot row by row: `row(heard)` goes on by sample_s and gives the columns of BOT at its beginning."""

    def __init__(self, params):
        _lib.robot_open.restype = ctypes.c_void_p
        self._robot = ctypes.c_void_p(_lib.robot_open(ROBOT.pack(params)))
        self._out = _doubles(len(BOT))
        self._heard = _doubles(3)

    def row(self, heard):
        self._heard[:] = array.array("d", heard)
        if _lib.robot_row(self._robot, _pointer(self._heard), _pointer(self._out)):
            raise ArithmeticError("the hidden robot stopped being finite")
        return dict(zip(BOT, self._out))

    def change(self, params):
        _lib.robot_change(self._robot, ROBOT.pack(params))

    def close(self):
        _lib.robot_close(self._robot)


def inner_products(rows):
    """Matrix of the inner products of equally long series."""
    m, n = len(rows), len(rows[0])
    flat = array.array("d")
    for row in rows:
        flat.extend(row)
    out = _doubles(m * m)
    _lib.inner_products(_pointer(flat), m, n, _pointer(out))
    return [list(out[k * m : (k + 1) * m]) for k in range(m)]

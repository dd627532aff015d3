"""`omnihil serve` with an image on a board that has ports of the test's own.

    with on_board(image, board_text("vesc_410_f405.toml") + '[[port]]\\nof = "USART6"\\nas = "pty:{folder}/vesc"\\n') as bench:
        port = serial.Serial(bench.path("vesc"))
"""
import os
import sys

HERE = os.path.dirname(__file__)
sys.path.insert(0, os.path.join(HERE, "..", "serve"))
import bench as benches  # noqa: E402


def board_text(name):
    with open(os.path.join(HERE, "..", "..", "..", "boards", name), encoding="utf-8") as file:
        return file.read()


def on_board(image, board, *arguments, typed=None):
    """{folder} in the board's text is the bench's own."""
    return benches.Bench(["--physics", "planar", "--firmware", image, "--board", "{folder}/board.toml", *arguments],
                         files={"board.toml": board}, typed=typed)

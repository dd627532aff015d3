"""Writes a case as its owner would have it: dataset.toml, model.toml and one CSV per run."""
import math


def toml_of(head, sections):
    lines = [f"{k} = {v}" for k, v in head.items()]
    for name, keys in sections.items():
        lines += ["", f"[{name}]"] + [f"{k} = {v}" for k, v in keys.items()]
    return "\n".join(lines) + "\n"


def write_model(path, rig_name, sections):
    path.write_text(toml_of({"format": '"omnihil-model/1"', "rig": f'"{rig_name}"'}, sections))


def write_dataset(folder, title, rig_name, channels, runs):
    """`channels`: {signal: {key: text}}; `runs`: [{file, use, excitation}]."""
    lines = [
        'format = "omnihil-dataset/1"',
        f'title = "{title}"',
        f'rig = "{rig_name}"',
        'model = "model.toml"',
        "",
        "[channels]",
    ]
    lines += [
        f"{signal} = {{ " + ", ".join(f"{k} = {v}" for k, v in keys.items()) + " }"
        for signal, keys in channels.items()
    ]
    for run in runs:
        lines += ["", "[[runs]]"] + [f'{k} = "{v}"' for k, v in run.items()]
    (folder / "dataset.toml").write_text("\n".join(lines) + "\n")


def cell(value):
    if value is None:
        return ""
    return str(int(value)) if value == math.floor(value) and abs(value) < 1e15 else f"{value:.7g}"


def write_csv(path, columns):
    """`columns`: {name: values}, all equally long; None is an empty cell."""
    names = list(columns)
    rows = [",".join(names)]
    rows += [",".join(map(cell, row)) for row in zip(*columns.values())]
    path.write_text("\n".join(rows) + "\n")

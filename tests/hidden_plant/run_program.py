"""Lets the program under test work on a case. It sees the case's folder and nothing else; what it says is kept as it is."""
import json
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import tomllib

import dataset


def call(program, words, timeout, cwd):
    """Runs the program. Returns {code, seconds, text}; code None when the time ran out."""
    start = time.monotonic()
    process = subprocess.Popen(
        [str(program), *map(str, words)],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    try:
        text, _ = process.communicate(timeout=timeout)
        code = process.returncode
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        text, _ = process.communicate()
        code = None
    return {"code": code, "seconds": time.monotonic() - start, "text": text[-6000:]}


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, json.JSONDecodeError):
        return None


def final_model(diagnosis, folder):
    """The model the diagnosis ended with, as nested tables; {} where it gives none. `model` may be a path or the text."""
    model = ((diagnosis or {}).get("final") or {}).get("model")
    if isinstance(model, dict):
        return model
    if not isinstance(model, str) or not model:
        return {}
    try:
        if "\n" in model:
            return tomllib.loads(model)
        path = pathlib.Path(model)
        return tomllib.loads((path if path.is_absolute() else folder / path).read_text())
    except (OSError, tomllib.TOMLDecodeError):
        return {}


def diagnose(program, case_folder, timeout, jobs):
    """One diagnosis in a copy of the case, so that nothing it writes stays."""
    with tempfile.TemporaryDirectory(prefix="blind-run-") as scratch:
        folder = pathlib.Path(scratch) / "case"
        shutil.copytree(case_folder, folder)
        out = pathlib.Path(scratch) / "diagnosis.json"
        result = call(
            program, ["diagnose", folder, "--json", out, "--seed", 1, "--jobs", jobs], timeout, scratch
        )
        result["diagnosis"] = read_json(out)
        result["final_model"] = final_model(result["diagnosis"], folder)
        return result


def oracle_sections(nominal, effects):
    """The nominal model with the true effects in the catalogue's form, started at their true values."""
    sections = {}

    def add(prefix, table):
        for key, value in table.items():
            if isinstance(value, dict) and "value" not in value:
                add(f"{prefix}.{key}" if prefix else key, value)
            elif prefix:
                text = value
                if isinstance(value, dict):
                    text = "{ " + ", ".join(f"{k} = {json.dumps(v)}" for k, v in value.items()) + " }"
                sections.setdefault(prefix, {})[key] = text if isinstance(text, str) else json.dumps(text)

    add("", nominal)
    for effect in effects:
        keys = {}
        for name, value in effect["parameters"].items():
            fixed = name in ("order", "pulses_per_turn", "exponent") or value == 0
            keys[name] = f"{value!r}" if fixed else f"{{ value = {value!r}, tolerance = 0.3 }}"
        sections[f"effects.{effect['id']}"] = keys
    return sections


def oracle(program, case_folder, answer, timeout):
    """Fits the true effect in the catalogue's form and compares: the smallest error one can ask for."""
    with tempfile.TemporaryDirectory(prefix="blind-oracle-") as scratch:
        folder = pathlib.Path(scratch) / "case"
        shutil.copytree(case_folder, folder)
        nominal = tomllib.loads((folder / "model.toml").read_text())
        true_form, fitted, out = (
            folder / "true_form.toml",
            folder / "fitted.toml",
            pathlib.Path(scratch) / "compare.json",
        )
        dataset.write_model(true_form, answer["rig"], oracle_sections(nominal, answer["effects"]))
        fit = call(
            program,
            [
                "fit",
                folder,
                "--model",
                true_form,
                "--write",
                fitted,
                "--json",
                pathlib.Path(scratch) / "fit.json",
            ],
            timeout,
            scratch,
        )
        if not fitted.exists():
            return {"code": fit["code"], "text": fit["text"]}
        compare = call(program, ["compare", folder, "--model", fitted, "--json", out], timeout, scratch)
        return {
            "code": compare["code"],
            "seconds": fit["seconds"] + compare["seconds"],
            "text": compare["text"][-1500:],
            "compare": read_json(out),
        }

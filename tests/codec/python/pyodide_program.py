"""What the package answers about box.vtu and box.qtet in the present folder, as JSON: once by
libqtet.so, once in Pyodide."""
import array
import dataclasses
import hashlib
import json
import os
import pathlib
import re

import numpy
import qtet


def digest(data):
    return hashlib.sha256(data if isinstance(data, bytes) else data.tobytes()).hexdigest()


def raised(call):
    try:
        call()
    except OSError as error:  # its number is another one
        return f"{type(error).__name__}: {error.filename}"
    except Exception as error:
        text = re.sub(r"qtet-(node-)?page-\w+", "TEMPORARY", str(error))
        text = text.replace(os.getcwd(), "HERE")
        return f"{type(error).__name__}: {text}"
    return "nothing"


def of_arrays(log, *choice):
    arrays = log.arrays(*choice)
    parts = {"points": arrays.points, "cells": arrays.cells, "boundary": arrays.boundary}
    parts.update({**arrays.point_data, **arrays.cell_data})
    return {name: [part.dtype.name, part.shape, digest(part)] for name, part in parts.items()}


def of_log(source):
    with qtet.open(source) as log:
        counts = []
        for level in range(log.info.levels):
            log.refine(level)
            counts.append([log.counts(), dataclasses.asdict(log.level_info(level))])
        return {
            "info": dataclasses.asdict(log.info),
            "fields": [dataclasses.asdict(field) for field in log.fields],
            "series": [dataclasses.asdict(series) for series in log.all_series],
            "levels": counts,
            "of": [log.level_of_tetrahedra(500), log.level_of_error("boundary", 0.01)],
            "of field": [log.level_of_error(field.name, 0.05) for field in log.fields],
            "no field": raised(lambda: log.level_of_error("nothing", 1)),
            "arrays": of_arrays(log),
        }


def packed(values, kind, code, *shape):
    return numpy.frombuffer(array.array(code, values).tobytes(), kind).reshape(shape)


def simplified():
    """The cube of 8 x 8 x 8 cells, and two ways in which it cannot be simplified."""
    n, kuhn = 9, ((0, 9, 90, 91), (0, 90, 81, 91), (0, 81, 82, 91), (0, 82, 1, 91), (0, 1, 10, 91))
    kuhn = (*kuhn, (0, 10, 9, 91))
    places = [(i % n / 8, i // n % n / 8, i // n**2 / 8) for i in range(n**3)]
    starts = [i for i, place in enumerate(places) if max(place) < 1]
    points = packed([x for place in places for x in place], "float64", "d", n**3, 3)
    corners = [start + step for start in starts for cell in kuhn for step in cell]
    cells = packed(corners, "int32", "i", len(starts) * 6, 4)
    heat = packed([x * x + y for x, y, _ in places], "float32", "f", n**3)
    part = packed([i % 3 for i in range(len(cells))], "uint8", "B", len(cells))
    options = {
        "point_data": {"Heat": heat},
        "cell_data": {"Part": part},
        "source": "cube",
        "base_cells": 200,
        "errors": {"Heat": "0.1%"},
        "field_weights": {"Heat": 2},
        "regions": "Part",
    }
    log = qtet.simplify(points, cells, **options)
    qtet.simplify(points, cells, path="cube.qtet", **options)
    assert pathlib.Path("cube.qtet").read_bytes() == log
    wrong = packed([*corners[:-1], n**3], "int32", "i", len(starts) * 6, 4)
    return {
        "log": digest(log),
        "its": of_log(log),
        "wrong cells": raised(lambda: qtet.simplify(points, wrong)),
        "wrong option": raised(lambda: qtet.simplify(points, cells, position_bits=99)),
    }


def page(source, name, **more):
    told = qtet.page(source, name, **more)
    return [told, digest(pathlib.Path(name).read_bytes())]


def answers():
    log = pathlib.Path("box.qtet").read_bytes()
    pathlib.Path("cut.qtet").write_bytes(log[: len(log) // 2])
    with qtet.open("box.qtet") as opened:
        pages = [page(opened, "open.html"), page("box.vtu", "box.html", max_bytes=600_000)]
    return {
        "version": qtet.__version__,
        "file": of_log("box.qtet"),
        "bytes": of_log(log),
        "pages": pages,
        "shown": digest(qtet.show("box.vtu", field="Scalar").page.encode()),
        "simplified": simplified(),
        "no mesh": raised(lambda: qtet.page("nothing.vtu", "no.html")),
        "no page": raised(lambda: qtet.page("cut.qtet", "no.html")),
        "cut": raised(lambda: qtet.open("cut.qtet")),
        "no log": raised(lambda: qtet.open(b"no log")),
    }


print(json.dumps(answers(), sort_keys=True, default=str))

"""A run that goes on while `qtet add-steps --follow --push` adds its steps to a log, and is killed
again and again: the log and the server's lose no step and have none twice.
   follow_test.py FOLDER-OF-PROGRAMS FOLDER-TO-WRITE-TO [SEED]"""
import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
import urllib.request

BIN, OUT = map(pathlib.Path, sys.argv[1:3])
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(1 << 30)
KILLS, STEPS, TOKEN = 20, 40, "0123456789abcdefghijklmn"
# The machine may be slow, and only a hang ends here.
PATIENCE_SECONDS = 300
print("seed", SEED, flush=True)
RANDOM = random.Random(SEED)
ENVIRONMENT = {**os.environ, "QTET_TOKEN": TOKEN}


def qtet(*words):
    return subprocess.run(
        [BIN / "qtet", *map(str, words)], cwd=OUT, check=True, capture_output=True, text=True
    ).stdout


def write_collection(steps):
    """As solvers do: beside the old one, then in its place."""
    rows = "".join(f'<DataSet timestep="{s / 10}" file="s{s}.vtu"/>' for s in range(steps))
    (OUT / "new.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{rows}</Collection></VTKFile>'
    )
    (OUT / "new.pvd").rename(OUT / "run.pvd")


def start_server():
    (OUT / "meshes").mkdir()
    (OUT / "tokens").write_text(f"write * {TOKEN}\n")
    server = subprocess.Popen(
        [BIN / "qtet-server", "meshes", "--port", "0", "--tokens", "tokens"],
        cwd=OUT,
        stdout=subprocess.PIPE,
        text=True,
    )
    for line in server.stdout:
        if "http://" in line:
            return server, "http://" + line.split("http://")[1].split("/")[0].split()[0]
    sys.exit("the server did not start")


def follow(url):
    with open(OUT / "follow.log", "a") as log:
        return subprocess.Popen(
            [BIN / "qtet", "add-steps", "run.qtet", "run.pvd", "--follow", "--every", "0.1"]
            + ["--push", url],
            cwd=OUT,
            env=ENVIRONMENT,
            stdout=log,
            stderr=log,
        )


def served_fields(url):
    with urllib.request.urlopen(url + "/v1/meshes/run") as answer:
        return [field["name"] for field in json.load(answer)["fields"]]


def wait_until(what, done):
    end = time.monotonic() + PATIENCE_SECONDS
    while not done():
        if time.monotonic() > end:
            sys.exit(f"after {PATIENCE_SECONDS} s: {what}; see follow.log")
        time.sleep(0.05)


GRID = 5
PLACES = [(i, j, k) for i in range(GRID) for j in range(GRID) for k in range(GRID)]


def cells():
    """Each cube as six tetrahedra round its diagonal."""
    for i, j, k in (place for place in PLACES if max(place) < GRID - 1):
        at = lambda bits: PLACES.index((i + (bits >> 2), j + (bits >> 1 & 1), k + (bits & 1)))
        for middle in ((4, 6), (6, 2), (2, 3), (3, 1), (1, 5), (5, 4)):
            yield [at(bits) for bits in (0, *middle, 7)]


CELLS = list(cells())


def array(kind, name, values, components=1):
    return (
        f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
        + " ".join(map(str, values))
        + "</DataArray>"
    )


def write_step(step):
    values = [x + 0.3 * y * math.sin(0.2 * step + z) for x, y, z in PLACES]
    (OUT / f"s{step}.vtu").write_text(
        '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(PLACES)}" NumberOfCells="{len(CELLS)}">'
        f'<PointData>{array("Float64", "T", values)}</PointData>'
        f'<Points>{array("Float64", "P", (x for place in PLACES for x in place), 3)}</Points>'
        "<Cells>"
        + array("Int64", "connectivity", (v for cell in CELLS for v in cell))
        + array("Int64", "offsets", range(4, 4 * len(CELLS) + 1, 4))
        + array("UInt8", "types", [10] * len(CELLS))
        + "</Cells></Piece></UnstructuredGrid></VTKFile>"
    )


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    for step in range(2):
        write_step(step)
    write_collection(2)
    qtet("simplify", "run.pvd", "--time", "all", "-o", "run.qtet")
    server, url = start_server()
    follower = follow(url)
    try:
        kills = 0
        for step in range(2, STEPS):
            # The list names a step that is not there yet, as a solver's may.
            write_collection(step + 1)
            time.sleep(RANDOM.uniform(0, 0.2))
            write_step(step)
            if kills < KILLS:
                kills += 1
                time.sleep(RANDOM.uniform(0, 0.2))
                follower.send_signal(signal.SIGKILL)
                follower.wait()
                qtet("verify", "run.qtet")
                follower = follow(url)
        assert kills == KILLS
        expected = sorted(f"T@{s / 10:g}" for s in range(STEPS))
        wait_until("the server lacks steps", lambda: len(served_fields(url)) == STEPS)
        assert sorted(served_fields(url)) == expected, "a step is there twice, and one is not"
        follower.send_signal(signal.SIGTERM)
        assert follower.wait() == 0, "SIGTERM ends it in order"
        qtet("verify", "run.qtet", "--against", "run.pvd")
        left = [path.name for path in OUT.glob("*.qtet*")]
        print(len(left) - 1, "files of killed writers are left:", left[:4])
    finally:
        follower.kill()
        server.kill()


if __name__ == "__main__":
    main()

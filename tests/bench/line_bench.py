#!/usr/bin/env python3
"""qtet-server on slow lines: how soon a changed target takes effect, what throughput is left, and how
evenly many clients share a line. The lines are tests/support/line's, so no netem is needed.

  line_bench.py --bin build/release/bin --log LOG.qtet [--before SERVER] [--only latency,share]

`--before` is an older qtet-server, measured in turns with the new one. Needs what Line needs.
Congestion controls that this kernel does not allow, and rates for which the log is too short, are
named and left out. The defaults suit the 25.7 MB of `server_log LOG.qtet 60`.
"""
import argparse, pathlib, select, shutil, statistics, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support" / "line"))
import line as lines
from server import running
from stream import BINARY, Stream

RTT = 0.05  # seconds
RATES = {"0.4": 50_000, "2": 250_000, "20": 2_500_000}  # Mbit/s, and bytes a second
QUEUES = (100, 1000)  # packets
SHARED, CLIENTS = "20", 20
SETTLE = 3.0  # seconds until a stream is measured
TARGET_EVERY = 1.5
# the server measured
OPTIONS = "--threads 1 --max-connections-per-address 0 --max-requests-per-second 0".split()


def refusalOf(congestion):
    """Why this kernel does not take it for new connections; "": it does. It may have one that it
    allows in the machine's own namespace alone."""
    try:
        lines.CONGESTION.write_text(congestion)
        return ""
    except OSError as error:
        return error.strerror


def longEnough(logBytes, rate, seconds):
    """Whether a stream at the line's full rate lasts until its last target has been watched."""
    return logBytes > rate * (seconds + TARGET_EVERY + 10 * RTT)


def target_changes(program, folder, rate, queue, congestion, seconds):
    """For each target that is changed: ms to the first byte of the first frame of the new plan and to
    its last, KB that came meanwhile before it. And bytes a second of the whole stream."""
    out = []
    with lines.Line(rate, RTT / 2, queue, congestion) as line, running(
        program, folder, *OPTIONS
    ) as (
        port,
        mesh,
    ):
        with line.client():
            stream = Stream(lines.SERVER, port)
        stream.open(*mesh)
        stream.until(lambda f: f.kind == BINARY, 60)  # the head, which is in every plan
        began, before = time.monotonic(), stream.received
        stream.until(lambda f: time.monotonic() > began + SETTLE, 60)
        while time.monotonic() < began + seconds:
            asked, had = time.monotonic(), stream.received
            stream.say(type="target", target=None)
            stream.until(lambda f: f.text and f.text["type"] == "planned", 60)
            first = stream.until(lambda f: f.kind == BINARY, 60)
            out.append((first.began - asked, first.ended - asked, first.first - had))
            for frame in stream.frames(asked + TARGET_EVERY):
                if frame.text and frame.text["type"] == "done":
                    raise RuntimeError("the log is too short for this line")
        return out, (stream.received - before) / (time.monotonic() - began)


def share(program, folder, rate, queue, congestion, seconds):
    """Jain's index of the clients' bytes, and bytes a second of all."""
    with lines.Line(rate, RTT / 2, queue, congestion) as line, running(
        program, folder, *OPTIONS
    ) as (
        port,
        mesh,
    ):
        streams = []
        with line.client():
            for _ in range(CLIENTS):
                streams.append(Stream(lines.SERVER, port))
                streams[-1].open(*mesh)
        began, counted = time.monotonic(), None
        while (now := time.monotonic()) < began + SETTLE + seconds:
            if counted is None and now > began + SETTLE:
                counted = [s.received for s in streams]
            for ready in select.select([s.socket for s in streams], [], [], 0.1)[0]:
                ready_stream = next(s for s in streams if s.socket is ready)
                ready_stream.take()
        bytes_each = [s.received - c for s, c in zip(streams, counted)]
        for s in streams:
            s.close()
    jain = sum(bytes_each) ** 2 / (CLIENTS * sum(b * b for b in bytes_each))
    return jain, sum(bytes_each) / seconds


def latency_table(servers, folder, args):
    print(
        "| congestion control | queue | Mbit/s | first byte, ms | whole frame, ms | KB before it"
        " | throughput, new over old |\n|---|---|---|---|---|---|---|"
    )
    for congestion in args.congestion:
        for queue in args.queues:
            for name in args.rates:
                ways = {}
                for _ in range(args.rounds):
                    for which, program in servers.items():
                        targets, rate = target_changes(
                            program, folder, RATES[name], queue, congestion, args.seconds
                        )
                        ways.setdefault(which, []).append((targets, rate))
                cells = []
                for i, scale in ((0, 1e3), (1, 1e3), (2, 1e-3)):
                    medians = [
                        statistics.median(t[i] for targets, _ in ways[w] for t in targets)
                        for w in servers
                    ]
                    cells.append(" -> ".join(f"{scale * median:.0f}" for median in medians))
                rates = [statistics.median(rate for _, rate in ways[w]) for w in servers]
                print(
                    f"| {congestion} | {queue} | {name} | {cells[0]} | {cells[1]} | {cells[2]}"
                    f" | {rates[-1] / rates[0]:.2f} ({rates[-1] / RATES[name]:.2f} of the line) |",
                    flush=True,
                )


def share_table(servers, folder, args):
    print(
        f"\n{CLIENTS} clients on one line of {SHARED} Mbit/s:\n\n"
        "| congestion control | queue | Jain's index | throughput, new over old |\n|---|---|---|---|"
    )
    for congestion in args.congestion:
        for queue in args.queues:
            found = {w: [] for w in servers}
            for _ in range(args.rounds):
                for which, program in servers.items():
                    found[which].append(
                        share(program, folder, RATES[SHARED], queue, congestion, 2 * args.seconds)
                    )
            jain = " -> ".join(f"{statistics.median(j for j, _ in found[w]):.2f}" for w in servers)
            rates = [statistics.median(rate for _, rate in found[w]) for w in servers]
            print(
                f"| {congestion} | {queue} | {jain} | {rates[-1] / rates[0]:.2f}"
                f" ({rates[-1] / RATES[SHARED]:.2f} of the line) |",
                flush=True,
            )


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--bin", type=pathlib.Path, required=True)
    options.add_argument("--log", type=pathlib.Path, required=True)
    options.add_argument("--before", type=pathlib.Path)
    options.add_argument("--only", default="latency,share")
    options.add_argument("--rates", type=lambda s: s.split(","), default=list(RATES))
    options.add_argument(
        "--queues", type=lambda s: [int(q) for q in s.split(",")], default=list(QUEUES)
    )
    options.add_argument(
        "--congestion", type=lambda s: s.split(","), default=["bbr", "reno", "cubic"]
    )
    options.add_argument("--rounds", type=int, default=1)
    options.add_argument("--seconds", type=float, default=6)
    args = options.parse_args()
    lines.inNamespaces()
    for congestion in list(args.congestion):
        if why := refusalOf(congestion):
            print(f"{congestion} is not allowed by this kernel ({why}) and left out\n")
            args.congestion.remove(congestion)
    if not args.congestion:
        lines.skip("no congestion control is allowed")
    for name in list(args.rates):
        if not longEnough(args.log.stat().st_size, RATES[name], args.seconds):
            print(f"the log is too short for {name} Mbit/s, which is left out\n")
            args.rates.remove(name)
    folder = pathlib.Path(tempfile.mkdtemp())
    shutil.copy(args.log, folder / "bench.qtet")
    servers = {"before": args.before} if args.before else {}
    servers["new"] = args.bin / "qtet-server"
    if "latency" in args.only:
        latency_table(servers, folder, args)
    if "share" in args.only:
        share_table(servers, folder, args)


main()

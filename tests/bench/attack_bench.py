#!/usr/bin/env python3
"""How long /livez of one address waits while 8 others attack with costly requests.

Each attacker has 8 connections with 8 pipelined requests each, from an address 127.0.0.N of its
own. The server runs with its defaults on two threads, beside the attackers on the same machine.
They run in processes of their own at a lower priority, since attackers have their own machines.

  attack_bench.py --bin build/release/bin [--logs 1000] [--seconds 6] [--attacks list,metrics]
"""
import argparse, atexit, collections, json, multiprocessing, os, pathlib, re, selectors, socket, ssl
import subprocess, sys, tempfile, threading, time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support" / "line"))
from stream import Stream

ADDRESSES, CONNECTIONS, PIPELINED = 8, 8, 8
READ_BYTES = 1 << 18
# Targets of a stream at once, and seconds between: below the bound of 250/s.
TARGETS, TARGETS_EVERY = 8, 0.04
ANSWER = re.compile(rb"HTTP/1\.1 (\d{3}) ")


def request(target, headers=""):
    return f"GET {target} HTTP/1.1\r\nHost: a\r\n{headers}\r\n".encode()


def make_logs(folder, bin_folder, count):
    tool = next(p for p in (bin_folder / "server_log", bin_folder.parent / "tests" / "server_log")
                if p.exists())
    for i in range(count):
        subprocess.run([tool, folder / f"part-{i:06}.qtet", "2", str(i)], check=True)
    subprocess.run([tool, folder / "large.qtet", "30"], check=True)


def connect(port, source, blocking=False):
    s = socket.socket()
    s.bind((source, 0))
    s.settimeout(10)
    s.connect(("127.0.0.1", port))
    s.setblocking(blocking)
    return s


class Attacker:
    """One connection, which asks again for each answer. Answers are counted by their first line."""

    def __init__(self, port, source, targets):
        self.port, self.source, self.targets, self.next = port, source, targets, 0
        self.open()

    def open(self):
        self.socket, self.tail = connect(self.port, self.source), b""
        self.ask(PIPELINED)

    def ask(self, count):
        for _ in range(count):
            self.socket.send(self.targets[self.next % len(self.targets)])
            self.next += 1

    def take(self, statuses):
        """False: the connection has ended."""
        try:
            data = self.socket.recv(READ_BYTES)
        except BlockingIOError:
            return True
        except OSError:
            return False
        if not data:
            return False
        found = ANSWER.findall(self.tail + data)
        self.tail = (self.tail + data)[-12:]
        if ANSWER.search(self.tail):
            self.tail = b""
        statuses.update(found)
        try:
            self.ask(len(found))
        except OSError:
            return False
        return True


def attack(port, targets, until, results):
    os.nice(10)
    statuses = collections.Counter()
    selector = selectors.DefaultSelector()
    for a in range(ADDRESSES):
        for _ in range(CONNECTIONS):
            one = Attacker(port, f"127.0.0.{11 + a}", targets)
            selector.register(one.socket, selectors.EVENT_READ, one)
    while time.monotonic() < until:
        for key, _ in selector.select(0.1):
            if key.data.take(statuses):
                continue
            selector.unregister(key.fileobj)
            key.fileobj.close()
            key.data.open()
            selector.register(key.data.socket, selectors.EVENT_READ, key.data)
    results.put(statuses)


def aim(port, mesh, until, results):
    """Target upon target."""
    os.nice(10)
    statuses, streams = collections.Counter(), []
    for i in range(ADDRESSES * CONNECTIONS):
        streams.append(Stream("127.0.0.1", port, f"127.0.0.{11 + i % ADDRESSES}"))
        streams[-1].say(type="open", mesh=mesh["id"], fields=[], credit=1)
    value = 0
    while time.monotonic() < until:
        begun = time.monotonic()
        for stream in list(streams):
            try:
                for _ in range(TARGETS):
                    value += 1
                    stream.say(type="target", target={"tetrahedra": value % 1000})
                statuses.update(f.text["type"] for f in stream.take() if f.text)
            except OSError:
                statuses["broken"] += 1
                streams.remove(stream)
        time.sleep(max(0, begun + TARGETS_EVERY - time.monotonic()))
    results.put(statuses)


def shake(port, source, until, results):
    """Handshake upon handshake."""
    os.nice(10)
    statuses = collections.Counter()
    threads = [
        threading.Thread(target=shake_in_turns, args=(port, source, until, statuses))
        for _ in range(CONNECTIONS)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    results.put(statuses)


def shake_in_turns(port, source, until, statuses):
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    while time.monotonic() < until:
        try:
            context.wrap_socket(connect(port, source, True)).close()
            statuses["done"] += 1
        except OSError:
            statuses["refused"] += 1


def measure(port, until, tls):
    """Seconds of /livez of a ninth address: in turns on a kept and on a new connection."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    times, kept = {"kept": [], "new": []}, None

    def open_one():
        s = connect(port, "127.0.0.99", True)
        s.settimeout(30)
        return context.wrap_socket(s) if tls else s

    kept = open_one()
    while time.monotonic() < until:
        for name in times:
            begun = time.monotonic()
            s = kept if name == "kept" else open_one()
            s.send(request("/livez"))
            if b" 200 " not in s.recv(4096):
                raise SystemExit("/livez is not 200")
            times[name].append(time.monotonic() - begun)
            if s is not kept:
                s.close()
        time.sleep(0.005)
    return times


def attacks(port, digest, size):
    gzip, part = "Accept-Encoding: gzip\r\n", "/v1/meshes/part-000000"
    log = f"/v1/logs/{digest}/log"
    ranges = "Range: bytes=" + ",".join(f"{i}-{i + 9}" for i in range(0, size, size // 50)) + "\r\n"
    return {
        "list": [request("/v1/meshes?limit=1000", gzip)],
        "list, a page each": [
            request(f"/v1/meshes?limit={1000 - i}", gzip) for i in range(900)
        ],
        "description": [request(f"/v1/meshes/part-{i:06}", gzip) for i in range(1000)],
        "conditional": [
            request("/v1/meshes?limit=1000", gzip + 'If-None-Match: "a", "b", W/"c"\r\n'),
            request(part, 'If-Match: "' + "x" * 2000 + '"\r\n'),
        ],
        "several ranges": [request(log, ranges)],
        "metrics": [request("/metrics")],
        "targets": aim,
        "TLS handshakes": None,
    }


def fetch(port, target):
    s = connect(port, "127.0.0.98", True)
    s.send(request(target, "Connection: close\r\n"))
    out = b""
    while data := s.recv(READ_BYTES):
        out += data
    return out


def ready(port, logs):
    """All logs are read."""
    for _ in range(3000):
        text = fetch(port, "/metrics").decode()
        if int(re.search(r"^qtet_meshes (\d+)", text, re.M)[1]) > logs:
            return
        time.sleep(0.1)
    raise SystemExit("the folder was not read in time")


def percentiles(times):
    if not times:
        return "none in time"
    times = sorted(times)
    at = [times[min(len(times) - 1, int(len(times) * q))] * 1e3 for q in (0.5, 0.99)]
    return " / ".join(f"{ms:.1f}" for ms in (*at, times[-1] * 1e3))


def run(options, folder, only):
    def start(*more):
        server = subprocess.Popen(
            [options.bin / "qtet-server", folder, "--port", "0", "--threads", "2", *more],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )
        atexit.register(server.kill)
        return server, int(re.search(r":(\d+)/", server.stdout.readline())[1])

    server, port = start()
    ready(port, options.logs)
    found = fetch(port, "/v1/meshes/large").decode()
    digest = re.search(r'"digest":"(\w+)"', found)[1]
    size = int(re.search(r'"bytes":(\d+)', found)[1])
    mesh = json.loads(found.split("\r\n\r\n", 1)[1])
    server.kill()
    print("| attack | kept connection, ms (p50 / p99 / most) | new connection, ms | answers |")
    print("|---|---|---|---|")
    for name, targets in attacks(port, digest, size).items():
        if only and not any(name.startswith(o) for o in only):
            continue
        tls = targets is None
        files = ["--tls-certificate", folder / "c.pem", "--tls-key", folder / "k.pem"]
        server, port = start(*(files if tls else []))
        if not tls:
            ready(port, options.logs)
        until, statuses = time.monotonic() + options.seconds, collections.Counter()
        results = multiprocessing.SimpleQueue()
        threads = (
            [multiprocessing.Process(target=shake, args=(port, f"127.0.0.{11 + i}", until, results))
             for i in range(ADDRESSES)]
            if tls
            else [multiprocessing.Process(target=look, args=(port, mesh, until, results))]
            if targets is look
            else [multiprocessing.Process(target=attack, args=(port, targets, until, results))]
        )
        for thread in threads:
            thread.start()
        time.sleep(0.2)
        times = measure(port, until, tls)
        for thread in threads:
            thread.join()
        while not results.empty():
            statuses.update(results.get())
        server.kill()
        server.wait()
        counts = ", ".join(
            f"{count} x {k.decode() if isinstance(k, bytes) else k}"
            for k, count in sorted(statuses.items(), key=str)
        )
        kept, new = percentiles(times["kept"]), percentiles(times["new"])
        print(f"| {name} | {kept} | {new} | {counts} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--logs", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=6)
    parser.add_argument("--attacks", default="", help="beginnings of names, with commas")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_logs(folder, options.bin, options.logs)
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj",
             "/CN=a", "-keyout", folder / "k.pem", "-out", folder / "c.pem"],
            check=True, stderr=subprocess.DEVNULL,
        )
        run(options, folder, [a for a in options.attacks.split(",") if a])


if __name__ == "__main__":
    main()

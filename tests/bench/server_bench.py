#!/usr/bin/env python3
"""qtet-server beside nginx and npm's ws: what a server's CPU second gives, how soon the first chunk
comes, what connections cost in memory.

The servers are pinned to core 0, the clients to core 1, one server runs at a time, and rounds
alternate between the servers, so that whatever else the machine does hits them alike. Needs nginx,
wrk, taskset and, for the last peer, a folder in which `npm install ws` was run.

  server_bench.py --bin build/release/bin --log LOG.qtet [--ws FOLDER] [--rounds 5] [--seconds 2]

`--veth bbr` measures the rows beside nginx over a veth pair between two network namespaces, with
that congestion control on both servers. Without it everything is on loopback, where qtet-server
chooses reno.
"""
import argparse, atexit, contextlib, json, os, pathlib, re, resource, selectors, signal, socket
import statistics, subprocess, sys, tempfile, time

TICK = os.sysconf("SC_CLK_TCK")
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support" / "line"))
import line as lines

CHUNK = 32 << 10


def cpu_seconds(pid):
    """Of a process and its children that live (nginx's worker)."""
    total = 0
    for p in [pid] + [
        int(c)
        for c in subprocess.run(
            ["pgrep", "-P", str(pid)], capture_output=True, text=True
        ).stdout.split()
    ]:
        fields = pathlib.Path(f"/proc/{p}/stat").read_text().rsplit(")", 1)[1].split()
        total += int(fields[11]) + int(fields[12])
    return total / TICK


def rss(pid):
    return (
        int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) << 10
    )


def kernel_tcp_bytes():
    return int(
        re.search(r"TCP:.* mem (\d+)", pathlib.Path("/proc/net/sockstat").read_text())[1]
    ) * os.sysconf("SC_PAGESIZE")


def start(command, ready=None):
    process = subprocess.Popen(
        ["taskset", "-c", "0"] + [str(c) for c in command],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    atexit.register(process.terminate)
    return process, (re.search(ready, process.stdout.readline())[1] if ready else None)


class Place:
    """Where the servers listen, and in what clients are begun."""

    host, client = "127.0.0.1", contextlib.nullcontext


def start_qtet(args, folder):
    process, port = start(
        [
            args.bin / "qtet-server",
            folder,
            "--host",
            Place.host,
            "--threads",
            1,
            "--port",
            0,
            "--max-connections",
            12000,
            "--max-connections-per-address",
            0,
            "--max-requests-per-second",
            0,
        ],
        r":(\d+)/",
    )
    return process, int(port)


def start_nginx(folder, scratch):
    with socket.socket() as s:
        s.bind((Place.host, 0))
        port = s.getsockname()[1]
    conf = scratch / "nginx.conf"
    conf.write_text(
        f"""user root; worker_processes 1; daemon off; pid {scratch}/pid; error_log /dev/null;
events {{ worker_connections 20000; }}
http {{ access_log off; sendfile on; tcp_nopush off; keepalive_requests 1000000000;
client_body_temp_path {scratch}/a; proxy_temp_path {scratch}/b;
fastcgi_temp_path {scratch}/c; uwsgi_temp_path {scratch}/d; scgi_temp_path {scratch}/e;
server {{ listen {Place.host}:{port}; root {folder}; default_type application/json; }} }}"""
    )
    process, _ = start(["nginx", "-c", conf])
    for _ in range(100):
        with socket.socket() as s:
            if s.connect_ex((Place.host, port)) == 0:
                return process, port
        time.sleep(0.05)
    sys.exit("nginx does not start")


class Meter:
    """CPU seconds from here on: of a server, and of it and its client, this process and what it
    ran. On loopback the kernel does the same work now in one's time, now in the other's: a send is
    finished by whoever happens to take in the acknowledgement.
    """

    def __init__(self, pid):
        self.pid, self.before = pid, self.now(pid)

    @staticmethod
    def now(pid):
        return cpu_seconds(pid), sum(os.times()[:4])

    def rates(self, amount):
        server, client = (b - a for a, b in zip(self.before, self.now(self.pid)))
        return amount / max(server, 1 / TICK), amount / max(server + client, 1 / TICK)


def wrk(pid, url, connections, seconds, header=None):
    """Requests for a CPU second of the server, and of both ends."""
    meter = Meter(pid)
    command = (
        ["taskset", "-c", "1", "wrk", "-t1", f"-c{connections}", f"-d{seconds}s"]
        + (["-H", header] if header else [])
        + [url]
    )
    with Place.client():
        out = subprocess.run(command, capture_output=True, text=True).stdout
    if "Non-2xx" in out:
        sys.exit(f"{url}: {out}")
    return meter.rates(int(re.search(r"(\d+) requests in", out)[1]))


# ---- WebSockets, as little of them as does


def masked(text):
    data = text.encode()
    head = (
        bytes([0x81, 0x80 | len(data)])
        if len(data) < 126
        else bytes([0x81, 0xFE]) + len(data).to_bytes(2, "big")
    )
    return head + bytes(4) + data


def web_socket(port):
    s = socket.create_connection(("127.0.0.1", port))
    s.sendall(
        b"GET /v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
        b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n"
    )
    answer = b""
    while not answer.endswith(b"\r\n\r\n"):
        answer += s.recv(4096)
    assert b" 101 " in answer, answer
    return s


def open_message(name):
    """`name` and its fields, all of them."""
    return masked(
        json.dumps({"type": "open", "mesh": name[0], "fields": name[1], "credit": 1 << 40})
    )


def streaming(pid, port, name, clients, seconds):
    """Bytes for a CPU second of the server, and of both ends; each client asks again when it has
    all."""
    poll = selectors.DefaultSelector()
    sockets = [web_socket(port) for _ in range(clients)]
    for s in sockets:
        poll.register(s, selectors.EVENT_READ)
        s.sendall(open_message(name))
    buffer = bytearray(1 << 20)
    end, total, meter = time.monotonic() + seconds, 0, Meter(pid)
    while time.monotonic() < end:
        for key, _ in poll.select(0.1):
            count = key.fileobj.recv_into(buffer)
            total += count
            if buffer[:count].endswith(b'"type":"done"}'):
                key.fileobj.sendall(open_message(name))
    rates = meter.rates(total)
    for s in sockets:
        s.close()
    return rates


def first_chunk(port, name, clients):
    """Median ms from all asking together to a client's first binary byte."""
    poll = selectors.DefaultSelector()
    sockets = [web_socket(port) for _ in range(clients)]
    for s in sockets:
        poll.register(s, selectors.EVENT_READ)
    message = masked(json.dumps({"type": "open", "mesh": name[0], "fields": [], "credit": 1}))
    began, times = time.monotonic(), []
    for s in sockets:
        s.sendall(message)
    while len(times) < clients:
        for key, _ in poll.select(5):
            data = key.fileobj.recv(1 << 16)
            if b"\x82\x7e" in data or b"\x82\x7f" in data:
                times.append(time.monotonic() - began)
                poll.unregister(key.fileobj)
    for s in sockets:
        s.close()
    return 1000 * statistics.median(times)


def idle_bytes(process, connect, count):
    """Of the server's memory for a connection that has had one answer and is silent."""
    time.sleep(0.3)
    before = rss(process.pid)
    sockets = [connect() for _ in range(count)]
    time.sleep(1)
    each = (rss(process.pid) - before) / count
    for s in sockets:
        s.close()
    return each


def stalled_bytes(process, port, name, count):
    """Of the server's and the kernel's memory for a client that asks for everything and reads
    nothing."""
    sockets = [web_socket(port) for _ in range(count)]
    time.sleep(0.3)
    before = rss(process.pid), kernel_tcp_bytes()
    for s in sockets:
        s.sendall(open_message(name))
    time.sleep(1)
    each = (rss(process.pid) - before[0]) / count, (kernel_tcp_bytes() - before[1]) / count
    for s in sockets:
        s.close()
    return each


def http_silent(port):
    s = socket.create_connection(("127.0.0.1", port))
    s.sendall(b"GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n")
    s.recv(4096)
    return s


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--bin", type=pathlib.Path, required=True)
    options.add_argument("--log", type=pathlib.Path, required=True)
    options.add_argument("--ws", type=pathlib.Path)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--seconds", type=int, default=2)
    options.add_argument("--idle", type=int, default=10000)
    options.add_argument("--veth", metavar="CONGESTION")
    args = options.parse_args()
    if args.veth:
        lines.inNamespaces()
        pair = lines.Pair(args.veth)
        atexit.register(pair.__exit__)
        Place.host, Place.client = lines.SERVER, pair.client
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    os.sched_setaffinity(0, {1})
    scratch = pathlib.Path(tempfile.mkdtemp())
    folder = scratch / "logs"
    folder.mkdir()
    (folder / "bench.qtet").write_bytes(args.log.read_bytes())
    qtet, port = start_qtet(args, folder)

    def get(path):
        with socket.create_connection((Place.host, port)) as s:
            s.sendall(
                f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode()
            )
            return b"".join(iter(lambda: s.recv(1 << 16), b"")).split(b"\r\n\r\n", 1)[1]

    listing = get("/v1/meshes")
    digest = json.loads(listing)["meshes"][0]["digest"]
    bench = "bench", json.loads(listing)["meshes"][0]["fields"]
    (folder / "meshes.json").write_bytes(listing)
    nginx, other = start_nginx(folder, scratch)
    log, size = f"/v1/logs/{digest}/log", args.log.stat().st_size
    print(
        f"log of {size} bytes, JSON of {len(listing)} bytes;"
        f" {args.rounds} rounds of {args.seconds} s\n"
    )
    print("| | qtet-server | peer | ratio | ratio with the client's CPU |\n|---|---|---|---|---|")

    def row(name, ours, theirs, unit, scale):
        a, b = (statistics.median(server for server, _ in rates) for rates in (ours, theirs))
        server, both = (
            statistics.median(x[i] / y[i] for x, y in zip(ours, theirs)) for i in (0, 1)
        )
        print(
            f"| {name} | {a / scale:.0f} {unit} | {b / scale:.0f} {unit}"
            f" | {server:.2f} | {both:.2f} |",
            flush=True,
        )

    for name, path, peer, connections, header, unit, scale in [
        (
            "64 KB ranges, 64 connections",
            log,
            "/bench.qtet",
            64,
            "Range: bytes=65536-131071",
            "MB",
            1e6 / 65536,
        ),
        (
            "1 MB ranges, 16 connections",
            log,
            "/bench.qtet",
            16,
            "Range: bytes=65536-1114111",
            "MB",
            1e6 / (1 << 20),
        ),
        ("whole files, 4 connections", log, "/bench.qtet", 4, None, "MB", 1e6 / size),
        ("1 KB JSON, 64 connections", "/v1/meshes", "/meshes.json", 64, None, "thousand", 1e3),
        (
            "1 KB JSON, a connection each",
            "/v1/meshes",
            "/meshes.json",
            64,
            "Connection: close",
            "thousand",
            1e3,
        ),
    ]:
        ours, theirs = [], []
        for _ in range(args.rounds):
            ours.append(
                wrk(
                    qtet.pid, f"http://{Place.host}:{port}{path}", connections, args.seconds, header
                )
            )
            theirs.append(
                wrk(
                    nginx.pid,
                    f"http://{Place.host}:{other}{peer}",
                    connections,
                    args.seconds,
                    header,
                )
            )
        row(name + " (nginx)", ours, theirs, unit, scale)
    if args.veth:
        return
    if args.ws:
        ws, ws_port = start(
            ["node", HERE / "server_peer.mjs", args.ws.resolve(), args.log, CHUNK], r"(\d+)"
        )
        for clients in (1, 64):
            ours, theirs = [], []
            for _ in range(args.rounds):
                ours.append(streaming(qtet.pid, port, bench, clients, args.seconds))
                theirs.append(streaming(ws.pid, int(ws_port), bench, clients, args.seconds))
            row(
                f"chunks by WebSocket, {clients} client{'s' * (clients > 1)} (ws)",
                ours,
                theirs,
                "MB",
                1e6,
            )
    print("\n| | qtet-server |\n|---|---|")
    for clients in (64, 1000):
        median = statistics.median(first_chunk(port, bench, clients) for _ in range(args.rounds))
        print(
            f"| first chunk, median, {clients} clients together | {median:.1f} ms |",
            flush=True,
        )
    user, kernel = stalled_bytes(qtet, port, bench, 64)
    print(
        f"| a stalled client, user and kernel | {user / 1024:.0f} + {kernel / 1024:.0f} KB |",
        flush=True,
    )
    for name, connect in [
        ("HTTP", lambda: http_silent(port)),
        ("WebSocket", lambda: web_socket(port)),
    ]:
        qtet.send_signal(signal.SIGTERM)
        qtet.wait()
        qtet, port = start_qtet(args, folder)
        kilobytes = idle_bytes(qtet, connect, args.idle) / 1024
        print(
            f"| {args.idle} idle connections, {name} | {kilobytes:.1f} KB each |",
            flush=True,
        )


main()

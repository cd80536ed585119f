#!/usr/bin/env python3
"""qtet-server beside npm's ws: chunks for a second of processor time, how soon the first chunk
comes, what connections cost in memory.

The servers are pinned to core 0, the client to core 1, and rounds alternate between the servers.
Needs taskset and, for the peer, a folder in which `npm install ws` was run.

  stream_bench.py --bin build/release/bin --log LOG.qtet [--ws FOLDER] [--rounds 5] [--seconds 2]
"""
import argparse, json, os, pathlib, re, resource, selectors, shutil, socket, statistics
import tempfile, time
from server_bench import HERE, Meter, answer, start, start_qtet

CHUNK = 32 << 10
HOST = "127.0.0.1"


def rss(pid):
    return (
        int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) << 10
    )


def kernel_tcp_bytes():
    return int(
        re.search(r"TCP:.* mem (\d+)", pathlib.Path("/proc/net/sockstat").read_text())[1]
    ) * os.sysconf("SC_PAGESIZE")


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
    args = options.parse_args()
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    os.sched_setaffinity(0, {1})
    folder = pathlib.Path(tempfile.mkdtemp())
    shutil.copy(args.log, folder / "bench.qtet")
    qtet, port = start_qtet(args.bin / "qtet-server", folder, HOST)
    mesh = json.loads(answer(HOST, port, "/v1/meshes")[1])["meshes"][0]
    bench = "bench", mesh["fields"]
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
        qtet.terminate()
        qtet.wait()
        qtet, port = start_qtet(args.bin / "qtet-server", folder, HOST)
        kilobytes = idle_bytes(qtet, connect, args.idle) / 1024
        print(
            f"| {args.idle} idle connections, {name} | {kilobytes:.1f} KB each |",
            flush=True,
        )


if __name__ == "__main__":
    main()

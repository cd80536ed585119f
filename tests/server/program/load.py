#!/usr/bin/env python3
"""Everything that qtet-server does, at once, by clients of every kind: for a sanitizer's server,
whose reports end in its exit code.

  load.py SERVER TOOL SCRATCH [--seconds 30] [--lives 4] [--threads 2] [--seed 1]

Each life is a server of its own, plain and TLS in turn, and ends by SIGTERM with all clients at
work. What comes is held against the logs that were served.
Exit code 1: a wrong answer, a connection that broke without a reason, a report, or a server that
did not end in good order.
"""
import argparse, base64, collections, contextlib, hashlib, http.client, json, os, pathlib, random
import re, shutil, signal, socket, ssl, struct, subprocess, sys, threading, time, traceback

READER, WRITER = "reader-of-the-load-is-me", "writer-of-the-load-is-me"  # 22 characters at least
ALL_TOKENS = f"write up* {WRITER}\nread * {READER}\nread open* anyone\n"
FEWER_TOKENS = f"write up* {WRITER}\nread open* anyone\n"
PATIENCE = 60  # seconds; a sanitizer's server is slow, two cores are few


class Broken(Exception):
    """The server ended a connection."""


class Life:
    def __init__(self, options, number):
        self.tls, self.seconds, self.number = number % 2 == 1, options.seconds, number
        self.scratch = options.scratch / f"life{number}"
        self.folder, self.tokens = self.scratch / "logs", self.scratch / "tokens"
        shutil.rmtree(self.scratch, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.sources = [path.read_bytes() for path in sorted(options.made.glob("*.qtet"))]
        self.logs = {hashlib.sha256(log).hexdigest(): log for log in self.sources}
        for i, log in enumerate(self.sources):
            (self.folder / f"open{i}.qtet").write_bytes(log)
            (self.folder / f"lab{i}.qtet").write_bytes(log)
        self.tokens.write_text(ALL_TOKENS)
        words = [
            options.server,
            self.folder,
            "--port",
            "0",
            "--admin",
            "127.0.0.1:0",
            "--threads",
            str(options.threads),
            "--tokens",
            self.tokens,
            "--cache-bytes",
            "3000000",
            "--access-log",
            self.scratch / "access",
            "--max-connections-per-address",
            "0",
            "--max-requests-per-second",
            "0",
        ]
        if self.tls:
            self.takeCertificate(options.made, "a", "a")
            words += ["--tls-certificate", self.scratch / "crt", "--tls-key", self.scratch / "key"]
        self.made = options.made
        self.errors = open(self.scratch / "stderr", "wb")
        self.server = subprocess.Popen(
            [str(word) for word in words], stdout=subprocess.PIPE, stderr=self.errors
        )
        ports = [re.search(rb":(\d+)", self.server.stdout.readline()) for _ in range(2)]
        self.port, self.adminPort = (int(found[1]) for found in ports)
        self.lock, self.counts, self.failures, self.bodies, self.figures, self.ending = (
            threading.Lock(),
            collections.Counter(),
            [],
            {},
            [],
            False,
        )

    def takeCertificate(self, made, certificate, key):
        for name, of in (("crt", certificate), ("key", key)):
            shutil.copyfile(made / f"{of}.{name}", self.scratch / f"{name}.new")
            os.replace(self.scratch / f"{name}.new", self.scratch / name)

    def connect(self):
        plain = socket.create_connection(("127.0.0.1", self.port), PATIENCE)
        return ssl._create_unverified_context().wrap_socket(plain) if self.tls else plain

    def ask(self, method, path, body=None, token=READER, keep=None, **headers):
        """Status, headers, body; `keep`, a list, holds the connection for the next one."""
        link = (
            keep[0]
            if keep
            else http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        )
        if not keep:
            link.sock = self.connect()
        if token:
            headers["Authorization"] = "Bearer " + token
        link.request(
            method, path, body, {name.replace("_", "-"): value for name, value in headers.items()}
        )
        answer = link.getresponse()
        out = answer.status, answer.headers, answer.read()
        if keep is None:
            link.close()
        elif not keep:
            keep.append(link)
        self.count(f"{method} {answer.status}")
        return out

    def count(self, what):
        with self.lock:
            self.counts[what] += 1

    def mesh(self, rng, keep=None):
        """The description of one of the meshes; None where it is away or may not be read now."""
        status, _, body = self.ask(
            "GET",
            "/v1/meshes/"
            + rng.choice(["open", "lab", "up"])
            + str(rng.randrange(len(self.sources))),
            keep=keep,
        )
        assert status in (200, 401, 404), status
        return json.loads(body) if status == 200 else None

    def work(self, does, seed):
        rng = random.Random(f"{self.number} {seed}")
        while not self.ending:
            try:
                does(self, rng)
            except (OSError, http.client.HTTPException, Broken) as broken:
                if not self.ending:
                    self.failures.append(f"{does.__name__}: {broken!r}")
            except Exception:
                if not self.ending:
                    self.failures.append(traceback.format_exc())

    def live(self, kinds):
        threads = [
            threading.Thread(target=self.work, args=(does, f"{does.__name__} {i}"))
            for does, many in kinds
            for i in range(many)
        ]
        for thread in threads:
            thread.start()
        try:
            code = self.server.wait(self.seconds)
        except subprocess.TimeoutExpired:
            self.server.send_signal(signal.SIGTERM)
            self.ending = True
            try:
                code = self.server.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self.failures.append("the server did not end")
                self.server.kill()
                code = self.server.wait()
        self.ending = True
        for thread in threads:
            thread.join()
        told = (self.scratch / "stderr").read_text(errors="replace")
        if code != 0:
            self.failures.append(f"exit code {code}")
        self.failures += re.findall(
            r"^.*(?:Sanitizer|runtime error|ended by an exception).*$", told, re.M
        )
        print(
            f"life {self.number}, {'TLS' if self.tls else 'plain'}:"
            f" {dict(sorted(self.counts.items()))}; the server counts {', '.join(self.figures)}",
            *self.failures[:20],
            sep="\n  ",
            flush=True,
        )
        return not self.failures


class Stream:
    """A WebSocket client that compares what comes with the logs."""

    def __init__(self, life, path):
        self.life, self.buffer, self.digests, self.received = life, b"", {}, 0
        self.socket = life.connect()
        self.socket.sendall(
            (
                f"GET {path} HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n"
            ).encode()
        )
        while b"\r\n\r\n" not in self.buffer:
            self.fill()
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])

    def fill(self):
        more = self.socket.recv(1 << 16)
        if not more:
            raise Broken("end")
        self.buffer += more

    def say(self, **message):
        text, mask = json.dumps(message).encode(), os.urandom(4)
        size = (
            bytes([0x80 | len(text)])
            if len(text) < 126
            else bytes([0xFE]) + struct.pack(">H", len(text))
        )
        self.socket.sendall(
            b"\x81" + size + mask + bytes(c ^ mask[i % 4] for i, c in enumerate(text))
        )

    def listen(self, seconds):
        """Takes what comes for so long; payload bytes."""
        before, end = self.received, time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                self.fill()
            except (TimeoutError, ssl.SSLWantReadError):
                break
            while self.takeFrame():
                pass
        self.socket.settimeout(PATIENCE)
        return self.received - before

    def takeFrame(self):
        if len(self.buffer) < 2:
            return False
        opcode, size, at = self.buffer[0] & 15, self.buffer[1], 2
        if size > 125:
            at = 4 if size == 126 else 10
            if len(self.buffer) < at:
                return False
            size = int.from_bytes(self.buffer[2:at], "big")
        if len(self.buffer) < at + size:
            return False
        data, self.buffer = self.buffer[at : at + size], self.buffer[at + size :]
        if opcode == 8:
            raise Broken(f"closed, {data!r}")
        if opcode == 1:
            message = json.loads(data)
            self.life.count("says " + message.get("code", message["type"]))
            if message["type"] == "opened":
                self.digests[message["stream"]] = message["digest"]
        elif opcode == 2:
            assert (
                data[16:] in self.life.logs[self.digests[struct.unpack("<I", data[:4])[0]]]
            ), "a frame that the log does not have"
            self.received += len(data) - 16
        return True


def someTarget(rng):
    return rng.choice(
        [
            None,
            {"level": rng.randrange(60)},
            {"bytes": rng.randrange(500_000)},
            {"tetrahedra": rng.randrange(40_000)},
            {"boundaryError": rng.random() / 20},
        ]
    )


def streams(life, rng):
    keep = []
    mesh, path = life.mesh(rng, keep), "/v1/stream"
    if rng.random() < 0.6:
        status, _, body = life.ask("POST", "/v1/tickets", keep=keep)
        assert status in (201, 401), status
        path += "?ticket=" + (json.loads(body)["ticket"] if status == 201 else "0" * 64)
    keep[0].close()
    client = Stream(life, path)
    assert client.status in (101, 401), client.status
    if mesh is None or client.status != 101:
        return
    fields = [field["key"] for field in mesh["fields"] if rng.random() < 0.5]
    opens = lambda: client.say(
        type="open",
        mesh=mesh["id"],
        fields=fields,
        target=someTarget(rng),
        credit=rng.randrange(1, 400_000),
    )
    opens()
    for _ in range(rng.randrange(60)):
        came = client.listen(rng.choice([0.001, 0.01, 0.05]))
        client.say(type="credit", bytes=came + 1)
        what = rng.randrange(12)
        if what < 7:
            client.say(type="target", target=someTarget(rng))
        elif what < 9:
            client.say(type="pause")
            client.say(
                type="resume", **({"have": {"chunks": rng.randrange(3)}} if what == 7 else {})
            )
        elif what == 9:
            client.say(type="cancel")
            opens()
    if rng.random() < 0.5:
        client.socket.sendall(b"\x88\x80abcd")
    client.socket.close()


def ranges(life, rng):
    keep = []
    mesh = life.mesh(rng, keep)
    for _ in range(20 if mesh else 0):
        log, first = life.logs[mesh["digest"]], rng.randrange(mesh["bytes"])
        last = min(first + rng.randrange(1, 100_000), len(log)) - 1
        root = "/v1/logs/" + mesh["digest"]
        status, _, body = life.ask("GET", root + "/log", keep=keep, Range=f"bytes={first}-{last}")
        assert status == 404 or (status == 206 and body == log[first : last + 1]), status
        status, headers, body = life.ask(
            "GET",
            root
            + rng.choice(
                ["/log", "/base", "/manifest", f"/chunks/{rng.randrange(mesh['chunks'])}"]
            ),
            keep=keep,
            Accept_Encoding="zstd, gzip",
        )
        assert status == 404 or headers["Content-Type"] == "application/json" or body in log, status
    keep[0].close()


def levels(life, rng):
    mesh = life.mesh(rng)
    if mesh is None:
        return
    form = rng.choice(["vtu", "vtk", "msh", "usda", "glb", "drc", "obj"])
    path = f"/v1/logs/{mesh['digest']}/levels/" + rng.choice(
        [f"{rng.randrange(len(mesh['levels']))}.{form}", f"fit.{form}?tets={rng.randrange(20000)}"]
    )
    if rng.random() < 0.1:
        path = f"/v1/logs/{mesh['digest']}/poster.webp"
    if rng.random() < 0.6:  # leaves before it is made, or in the midst of it
        socket = life.connect()
        socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer {READER}\r\n\r\n".encode()
        )
        time.sleep(rng.random() * 0.1)
        life.count("levels left")
        return socket.close()
    status, headers, body = life.ask("GET", path, Accept_Encoding=rng.choice(["", "zstd", "gzip"]))
    assert status in (200, 404, 503), status
    assert (
        status != 200 or life.bodies.setdefault(headers["ETag"], body) == body
    ), "other bytes under the same tag"


def uploads(life, rng):
    log, path = rng.choice(life.sources), f"/v1/meshes/up{rng.randrange(len(life.sources))}"
    digest, what = hashlib.sha256(log).hexdigest(), rng.randrange(6)
    if what == 0:
        status, _, _ = life.ask("DELETE", path, token=WRITER)
        assert status in (204, 404), status
    elif what == 1:
        status, _, _ = life.ask("PUT", path, log[:-1] + b"x", token=WRITER)
        assert status in (422, 503), status
    elif what == 2:
        status, _, _ = life.ask("PUT", path, log, token=rng.choice([None, READER]))
        assert status in (401, 403), status
    elif what == 3:  # breaks off, or leaves while the log is checked
        socket = life.connect()
        socket.sendall(
            f"PUT {path}?digest={digest} HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer {WRITER}\r\n"
            f"Content-Length: {len(log)}\r\n\r\n".encode()
            + log[: rng.choice([len(log), rng.randrange(len(log))])]
        )
        socket.close()
    else:
        status, _, body = life.ask("GET", f"{path}/upload?digest={digest}", token=WRITER)
        have = json.loads(body)["bytes"] if status == 200 else 0
        rest = f"{have}-{len(log) - 1}" if have < len(log) else "*"
        part = {"Content_Range": f"bytes {rest}/{len(log)}"} if have > 0 else {}
        status, _, _ = life.ask("PUT", f"{path}?digest={digest}", log[have:], token=WRITER, **part)
        assert status in (200, 201, 409, 503), status


def replaces(life, rng):
    target = life.folder / f"{rng.choice(['open', 'lab'])}{rng.randrange(len(life.sources))}.qtet"
    log, what = rng.choice(life.sources), rng.randrange(5)
    if what == 0:
        target.unlink(missing_ok=True)
    elif what == 1:
        target.write_bytes(log)  # into the file that is served
    else:
        beside = life.folder / ".beside"
        beside.write_bytes(log if what > 2 else log[: rng.randrange(len(log))])
        os.replace(beside, target)
    time.sleep(rng.choice([0.05, 0.5]))


def reloads(life, rng):
    life.tokens.with_suffix(".new").write_text(
        rng.choice([ALL_TOKENS, ALL_TOKENS, ALL_TOKENS, FEWER_TOKENS, "nonsense\n"])
    )
    os.replace(life.tokens.with_suffix(".new"), life.tokens)
    if life.tls:
        life.takeCertificate(life.made, *rng.choice(["aa", "bb", "ab"]))
    if not life.ending:
        life.server.send_signal(signal.SIGHUP)
        life.count("SIGHUP")
    time.sleep(rng.choice([0.1, 1]))


def watches(life, rng):
    link = http.client.HTTPConnection("127.0.0.1", life.adminPort, timeout=PATIENCE)
    for path in ("/metrics", "/readyz", "/livez", "/version"):
        link.request("GET", path)
        answer = link.getresponse()
        text = answer.read().decode()
        assert answer.status == 200 or life.ending, answer.status
        life.figures = (
            re.findall(r"^qtet_(levels_\w+_total \d+|uploads_\w+_total \d+)", text, re.M)
            or life.figures
        )
    link.close()
    status, _, body = life.ask("GET", "/v1/meshes?limit=3", token=rng.choice([None, READER]))
    assert status in (200, 401) and json.loads(body), status
    time.sleep(0.05)


def disturbs(life, rng):
    """No HTTP, half of a request, half of a handshake, many requests at once, nothing at all."""
    plain = socket.create_connection(("127.0.0.1", life.port), PATIENCE)
    plain.sendall(
        rng.choice(
            [
                b"",
                b"\x16\x03\x01\x02\x00\x01",
                b"GET / HTTP/1.1\r\nHo",
                b"\0" * 100,
                b"GET /v1/meshes HTTP/1.1\r\nHost: a\r\n\r\n" * 50,
            ]
        )
    )
    time.sleep(rng.random() * 0.1)
    if rng.random() < 0.5:
        with contextlib.suppress(OSError):  # the server may have gone first
            plain.shutdown(socket.SHUT_WR)
    plain.close()


def prepare(options):
    options.made = options.scratch / "made"
    options.made.mkdir(parents=True, exist_ok=True)
    run = lambda *words: subprocess.run(
        [str(word) for word in words],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    for i, cells in enumerate((2000, 10000, 20000)):
        run(options.tool, "sample", "fin", "--cells", cells, "-o", options.made / "fin.vtu")
        run(
            options.tool,
            "simplify",
            options.made / "fin.vtu",
            "-o",
            options.made / f"fin{i}.qtet",
        )
    for name in "ab":
        run(
            "openssl",
            "req",
            "-x509",
            "-newkey",
            "ec",
            "-pkeyopt",
            "ec_paramgen_curve:prime256v1",
            "-nodes",
            "-subj",
            "/CN=localhost",
            "-keyout",
            options.made / f"{name}.key",
            "-out",
            options.made / f"{name}.crt",
        )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name in ("server", "tool", "scratch"):
        parser.add_argument(name, type=lambda text: pathlib.Path(text).resolve())
    for name, default in (("seconds", 30), ("lives", 4), ("threads", 2), ("seed", 1)):
        parser.add_argument("--" + name, type=int, default=default)
    options = parser.parse_args()
    prepare(options)
    kinds = [
        (streams, 6),
        (ranges, 2),
        (levels, 4),
        (uploads, 2),
        (replaces, 1),
        (reloads, 1),
        (watches, 1),
        (disturbs, 1),
    ]
    sound = [Life(options, number).live(kinds) for number in range(options.lives)]
    return 0 if all(sound) else 1


sys.exit(main())

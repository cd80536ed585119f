#!/usr/bin/env python3
"""qtet-server beside nginx: what a second of processor time gives. Writes the table of SERVER.md.

The servers are pinned to core 0, the client (wrk) to core 1. Rounds alternate between the servers,
so that whatever else the machine does hits them alike. Both servers have the same congestion
control: on a veth pair between two network namespaces that of the system, on loopback reno, which
qtet-server chooses there. Needs nginx, wrk, openssl and taskset, and namespaces; says what lacks.

  server_bench.py --bin build/release/bin [--rounds 5] [--seconds 2] [--document SERVER.md]
"""
import argparse, atexit, contextlib, datetime, json, os, pathlib, platform, re, resource, shutil
import socket, statistics, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support" / "line"))
import line as lines

BEGIN, END = "<!-- begin: make bench-server -->", "<!-- end: make bench-server -->"
AGREES = 0.10  # a row stands if another day's run is as near

MEGABYTE = "Range: bytes=65536-1114111"
# name, connections, header, TLS, what is asked for, unit and its size, aim of both ends by veth
ROWS = [
    ("JSON", 64, None, False, "json", "thousand", 1e3, 1.0),
    ("64 KB ranges", 64, "Range: bytes=65536-131071", False, "log", "MB", 1e6 / 65536, 1.0),
    ("1 MB ranges", 16, MEGABYTE, False, "log", "MB", 1e6 / (1 << 20), 1.0),
    ("whole files", 4, None, False, "log", "MB", None, 1.0),
    ("JSON, a connection each", 64, "Connection: close", False, "json", "thousand", 1e3, 0.95),
    ("TLS: JSON", 64, None, True, "json", "thousand", 1e3, None),
    ("TLS: 1 MB ranges", 16, MEGABYTE, True, "log", "MB", 1e6 / (1 << 20), None),
    ("TLS: JSON, a connection each", 64, "Connection: close", True, "json", "thousand", 1e3, None),
]


def processor_seconds(pid):
    """Of a process and its children that live (nginx's worker), to the nanosecond."""
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return 1e-9 * sum(
        int((task / "schedstat").read_text().split()[0])
        for p in [pid, *children]
        for task in pathlib.Path(f"/proc/{p}/task").iterdir()
    )


class Meter:
    """Processor seconds from here on: of a server, and of it and its client, this process and what
    it ran. The kernel does the same work now in one's time, now in the other's: a send is finished
    by whoever happens to take in the acknowledgement.
    """

    def __init__(self, pid):
        self.pid, self.before = pid, self.now(pid)

    @staticmethod
    def now(pid):
        return processor_seconds(pid), sum(os.times()[:4])

    def rates(self, amount):
        server, client = (b - a for a, b in zip(self.before, self.now(self.pid)))
        return amount / server, amount / (server + client)


def start(command, ready=None):
    process = subprocess.Popen(
        ["taskset", "-c", "0"] + [str(c) for c in command],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    atexit.register(process.terminate)
    return process, (re.search(ready, process.stdout.readline())[1] if ready else None)


def start_qtet(program, folder, host, *options):
    unlimited = ["--max-connections-per-address", 0, "--max-requests-per-second", 0]
    command = [program, folder, "--host", host, "--port", 0, "--threads", 1]
    process, port = start(
        command + ["--max-connections", 12000] + unlimited + list(options), r":(\d+)/"
    )
    return process, int(port)


def free_port(host):
    with socket.socket() as s:
        s.bind((host, 0))
        return s.getsockname()[1]


def start_nginx(folder, scratch, host, certificate):
    """nginx's process, its port, and that of TLS."""
    port, secure = free_port(host), free_port(host)
    conf = scratch / "nginx.conf"
    conf.write_text(
        f"""user root; worker_processes 1; daemon off; pid {scratch}/pid; error_log /dev/null;
events {{ worker_connections 20000; }}
http {{ access_log off; sendfile on; tcp_nopush off; keepalive_requests 1000000000;
client_body_temp_path {scratch}/a; proxy_temp_path {scratch}/b;
fastcgi_temp_path {scratch}/c; uwsgi_temp_path {scratch}/d; scgi_temp_path {scratch}/e;
ssl_protocols TLSv1.3; ssl_certificate {certificate}.crt; ssl_certificate_key {certificate}.key;
server {{ listen {host}:{port} backlog=4096; listen {host}:{secure} ssl backlog=4096;
root {folder}; default_type application/json; }} }}"""
    )
    process, _ = start(["nginx", "-c", conf])
    for _ in range(100):
        with socket.socket() as s:
            if s.connect_ex((host, port)) == 0:
                return process, port, secure
        time.sleep(0.05)
    sys.exit("nginx does not start")


def make_certificate(path):
    command = "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2"
    files = ["-subj", "/CN=bench", "-keyout", f"{path}.key", "-out", f"{path}.crt"]
    subprocess.run(command.split() + files, check=True, capture_output=True)


def answer(host, port, path):
    """Head and body."""
    with socket.create_connection((host, port)) as s:
        s.sendall(f"GET {path} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n".encode())
        head, body = b"".join(iter(lambda: s.recv(1 << 16), b"")).split(b"\r\n\r\n", 1)
        return head + b"\r\n\r\n", body


def wrk(pid, url, connections, seconds, header, client):
    """Requests for a second of the server's processor time, and of both ends'."""
    command = ["taskset", "-c", "1", "wrk", "-t1", f"-c{connections}", f"-d{seconds}s"]
    meter = Meter(pid)
    with client():
        out = subprocess.run(
            command + (["-H", header] if header else []) + [url], capture_output=True, text=True
        ).stdout
    if "Non-2xx" in out or "requests in" not in out:
        sys.exit(f"{url}: {out}")
    return meter.rates(int(re.search(r"(\d+) requests in", out)[1]))


def enter(place):
    """Where the servers listen, and in what clients are begun."""
    system = lines.CONGESTION.read_text().strip()
    wanted = "reno" if place == "loopback" else os.environ.setdefault("QTET_CONGESTION", system)
    if place == "veth" or system != wanted:
        lines.inNamespaces()
        lines.CONGESTION.write_text(wanted)
    if place == "loopback":
        return "127.0.0.1", contextlib.nullcontext, wanted
    pair = lines.Pair(wanted)
    atexit.register(pair.__exit__)
    return lines.SERVER, pair.client, wanted


def measure(args):
    """Prints a place's rows as JSON: the rates of each round, ours and nginx's."""
    host, client, congestion = enter(args.place)
    limit = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit))
    os.sched_setaffinity(0, {1})
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        folder = scratch / "logs"
        folder.mkdir()
        shutil.copy(args.log, folder / "bench.qtet")
        make_certificate(scratch / "bench")
        files = [scratch / "bench.crt", "--tls-key", scratch / "bench.key"]
        program = args.bin / "qtet-server"
        plain = start_qtet(program, folder, host)
        secure = start_qtet(program, folder, host, "--tls-certificate", *files)
        head, listing = answer(host, plain[1], "/v1/meshes")
        (folder / "meshes.json").write_bytes(listing)
        nginx, port, port_of_tls = start_nginx(folder, scratch, host, scratch / "bench")
        digest = json.loads(listing)["meshes"][0]["digest"]
        ours = {"json": "/v1/meshes", "log": f"/v1/logs/{digest}/log"}
        theirs = {"json": "/meshes.json", "log": "/bench.qtet"}
        rounds = {}
        for name, connections, header, tls, what, *_ in ROWS:
            mine, scheme = (secure, "https") if tls else (plain, "http")
            url = f"{scheme}://{host}:{mine[1]}{ours[what]}"
            other = f"{scheme}://{host}:{port_of_tls if tls else port}{theirs[what]}"
            asked = connections, args.seconds, header, client
            rounds[name] = [
                (wrk(mine[0].pid, url, *asked), wrk(nginx.pid, other, *asked))
                for _ in range(args.rounds)
            ]
            print(name, file=sys.stderr)
        heads = len(head), len(answer(host, port, theirs["json"])[0])
        end = [plain[0], secure[0], nginx]
        for process in end:
            process.terminate()
            process.wait()
    print(json.dumps({"congestion": congestion, "heads": heads, "rounds": rounds}))


def amount(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.1f}"


def figure(ratios):
    return f"{statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})"


def earlier_runs(text, today):
    """Both ends' ratios of the latest run on another day, by place and row, and its date."""
    block = text[text.index(BEGIN) : text.index(END)]
    date = re.search(r"Measured on (\S+)", block)
    same = date is None or date[1] == today
    dates = re.search(r"the run of ([\d-]+)", block)
    out, place = {}, ""
    for row in block.splitlines():
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        if row.startswith("### "):
            place = row[4:].split(",")[0]
        elif len(cells) == 6 and (found := re.match(r"[\d.]+", cells[5 if same else 4])):
            out[place, cells[0]] = float(found[0])
    return out, (dates[1] if dates else None) if same else date[1]


def place_table(place, result, log_bytes, earlier, missed):
    out = [f"### {place}, {result['congestion']} on both sides", ""]
    out += ["| | qtet-server | nginx | server's ratio | both ends' ratio | another day |"]
    out += ["|---|---|---|---|---|---|"]
    for name, _, _, _, _, unit, scale, aim in ROWS:
        rounds = result["rounds"][name]
        scale = scale or 1e6 / log_bytes
        ours, theirs = (statistics.median(r[i][0] for r in rounds) / scale for i in (0, 1))
        server, both = ([r[0][i] / r[1][i] for r in rounds] for i in (0, 1))
        median = statistics.median(both)
        before = earlier.get((place, name))
        agrees = before and abs(median / before - 1) <= AGREES
        other = "none" if before is None else f"{before:.2f}" + ("" if agrees else ", differs")
        out.append(
            f"| {name} | {amount(ours)} {unit} | {amount(theirs)} {unit}"
            f" | {figure(server)} | {figure(both)} | {other} |"
        )
        if place == "veth" and aim and median < aim:
            missed.append(f"{name} {median:.2f} of {aim}")
    return out + [""]


def verdict(missed):
    """`missed` is None where nothing was measured by veth."""
    if missed is None:
        return "The aims by veth were not measured."
    return "Aims missed by veth, of both ends: " + ("; ".join(missed) or "none") + "."


def write_table(args):
    text = args.document.read_text()
    today = datetime.date.today().isoformat()
    earlier, other_day = earlier_runs(text, today)
    commit = subprocess.run(
        ["git", "-C", HERE, "describe", "--always", "--dirty", "--exclude=*"],
        capture_output=True,
        text=True,
    ).stdout.strip()
    missed, tables, heads, measured = [], [], None, False
    for place in ("veth", "loopback"):
        command = [sys.executable, __file__, "--place", place, "--bin", args.bin]
        command += ["--log", args.log, "--rounds", args.rounds, "--seconds", args.seconds]
        run = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, text=True)
        if run.returncode == lines.SKIPPED:
            tables += [f"### {place}", "", run.stdout.strip(), ""]
        elif run.returncode != 0:
            sys.exit(f"server_bench: {place} failed: {run.stdout}")
        else:
            result = json.loads(run.stdout)
            heads, measured = result["heads"], measured or place == "veth"
            tables += place_table(place, result, args.log.stat().st_size, earlier, missed)
    load = os.getloadavg()[2]
    out = [verdict(missed if measured else None), ""]
    out += [f"Measured on {today} at `{commit}`, Linux {platform.release()}."]
    out += [f"Rounds: {args.rounds} of {args.seconds} s each. Load of 15 minutes: {load:.1f}."]
    if heads:
        out += [f"The head of the JSON has {heads[0]} bytes, nginx's {heads[1]}."]
    if other_day:
        out += [f"Another day is the run of {other_day}."]
    out += ["", *tables]
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    args.document.write_text(text[:begin] + "\n" + "\n".join(out) + text[end:])
    print("\n".join(out))


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--bin", type=pathlib.Path, required=True)
    options.add_argument("--log", type=pathlib.Path, required=True)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--seconds", type=int, default=2)
    options.add_argument("--document", type=pathlib.Path, default=HERE / "SERVER.md")
    options.add_argument("--place", choices=["veth", "loopback"], help=argparse.SUPPRESS)
    args = options.parse_args()
    for program in ("nginx", "wrk", "openssl", "taskset"):
        if not shutil.which(program):
            lines.skip(f"{program} is not installed; Debian has a package")
    measure(args) if args.place else write_table(args)


if __name__ == "__main__":
    main()

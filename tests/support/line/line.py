"""Lines between two network namespaces, without netem: a veth pair, as fast as the machine; or two
TUN devices whose packets a program forwards, each way at a rate, after a delay, through a queue of
so many packets.

    inNamespaces()                      # once, first: skips where namespaces are not allowed
    with Line(rate=250_000, delay=0.025, queue=100) as line:
        ...                             # SERVER's programs run here
        with line.client(): socket.create_connection((SERVER, port))
"""
import collections, contextlib, ctypes, fcntl, multiprocessing, os, pathlib, select, signal, struct
import subprocess, sys, time

SERVER, CLIENT = "10.77.0.1", "10.77.0.2"
SKIPPED = 77  # a test's exit code
MTU = 1500
INSIDE = "QTET_IN_NAMESPACES"
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 1, 0x1000
CLONE_NEWNET = 0x40000000
PR_SET_PDEATHSIG = 1
CONGESTION = pathlib.Path("/proc/sys/net/ipv4/tcp_congestion_control")
AVAILABLE = pathlib.Path("/proc/sys/net/ipv4/tcp_available_congestion_control")
libc = ctypes.CDLL(None, use_errno=True)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def inNamespaces():
    """Runs the calling program again as root of new namespaces. Skips where that, or a TUN device,
    is not allowed."""
    if INSIDE in os.environ:
        return ip("link", "set", "lo", "up")
    try:
        allowed = subprocess.run(
            ["unshare", "-Urn", "sh", "-c", "ip link set lo up && exec 3<>/dev/net/tun"],
            capture_output=True,
        )
    except FileNotFoundError:
        skip("needs util-linux's unshare")
    if allowed.returncode != 0:
        skip("needs iproute2, user namespaces and /dev/net/tun")
    os.environ[INSIDE] = "1"
    os.execvp("unshare", ["unshare", "-Urn", sys.executable] + sys.argv)


def tun(name):
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TUN | IFF_NO_PI))
    return device


def ip(*arguments, of=None):
    enter = ["nsenter", "-n", "-t", str(of)] if of else []
    subprocess.run(enter + ["ip"] + [str(a) for a in arguments], check=True)


class Way:
    """One direction: packets leave at the rate, one behind the other, and arrive a delay later."""

    def __init__(self, source, target, rate, delay, queue):
        self.source, self.target = source, target
        self.rate, self.delay, self.queue = rate, delay, queue
        self.free = 0.0  # when the line has sent all it has taken
        self.leaving, self.arriving = collections.deque(), collections.deque()

    def take(self, now):
        """All packets that wait at the device; those for which there is no place are dropped."""
        with contextlib.suppress(BlockingIOError):
            while packet := os.read(self.source, MTU + 64):
                while self.leaving and self.leaving[0] <= now:
                    self.leaving.popleft()
                if len(self.leaving) >= self.queue:
                    continue
                self.free = max(self.free, now) + len(packet) / self.rate
                self.leaving.append(self.free)
                self.arriving.append((self.free + self.delay, packet))

    def give(self, now):
        """What has arrived; returns when the next packet does."""
        while self.arriving and self.arriving[0][0] <= now:
            with contextlib.suppress(OSError):
                os.write(self.target, self.arriving.popleft()[1])
        return self.arriving[0][0] if self.arriving else now + 1


def forward(ways):
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    while True:
        now = time.monotonic()
        wait = min(way.give(now) for way in ways) - time.monotonic()
        ready = select.select([way.source for way in ways], [], [], max(wait, 0))[0]
        now = time.monotonic()
        for way in ways:
            if way.source in ready:
                way.take(now)


class Ends:
    """The server's side is the namespace of the program, with `congestion` as its congestion
    control; the client's is a new one."""

    def __init__(self, congestion=None):
        if congestion:
            CONGESTION.write_text(congestion)
        self.own = os.open("/proc/self/ns/net", os.O_RDONLY)
        self.peer = subprocess.Popen(["unshare", "-n", "sleep", "infinity"])
        while os.readlink(f"/proc/{self.peer.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
            time.sleep(0.01)
        self.other = os.open(f"/proc/{self.peer.pid}/ns/net", os.O_RDONLY)

    def address(self):
        """The devices line0 here and line1 there are up from now on."""
        ip("link", "set", "line1", "netns", self.peer.pid)
        for name, own, other, of in (
            ("line0", SERVER, CLIENT, None),
            ("line1", CLIENT, SERVER, self.peer.pid),
        ):
            ip("link", "set", name, "mtu", MTU, "up", of=of)
            ip("addr", "add", own, "peer", other, "dev", name, of=of)

    @contextlib.contextmanager
    def client(self):
        """Sockets made within, and programs begun within, are the client's."""
        libc.setns(self.other, CLONE_NEWNET)
        try:
            yield
        finally:
            libc.setns(self.own, CLONE_NEWNET)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.peer.kill()
        self.peer.wait()
        os.close(self.own)
        os.close(self.other)


class Pair(Ends):
    """A veth pair."""

    def __init__(self, congestion=None):
        super().__init__(congestion)
        ip("link", "add", "line0", "type", "veth", "peer", "name", "line1")
        self.address()


class Line(Ends):
    """`rate` in bytes a second and `delay` in seconds are each way's, `queue` is in packets."""

    def __init__(self, rate, delay, queue, congestion=None):
        super().__init__(congestion)
        ends = [tun("line0"), tun("line1")]
        self.address()
        ways = [
            Way(ends[0], ends[1], rate, delay, queue),
            Way(ends[1], ends[0], rate, delay, queue),
        ]
        self.forwarder = multiprocessing.get_context("fork").Process(
            target=forward, args=(ways,), daemon=True
        )
        self.forwarder.start()
        for end in ends:
            os.close(end)

    def __exit__(self, *exception):
        self.forwarder.kill()
        self.forwarder.join()
        super().__exit__(*exception)

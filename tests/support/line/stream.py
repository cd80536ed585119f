"""A client of `/v1/stream` that notes when and behind how many bytes each frame comes."""
import base64, collections, dataclasses, json, os, select, socket, time

TEXT, BINARY = 1, 2
READ_BYTES = 1 << 16


@dataclasses.dataclass
class Frame:
    kind: int
    size: int
    first: int = 0  # bytes of the connection that came before it
    began: float = 0.0  # when its head was here
    ended: float = 0.0
    text: dict = None


class Stream:
    def __init__(self, host, port, source=None):
        """`source`: the address to come from."""
        source = (source, 0) if source else None
        self.socket = socket.create_connection((host, port), source_address=source)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
            f"Sec-WebSocket-Protocol: qtet.v1\r\n\r\n".encode()
        )
        answer = b""
        while not answer.endswith(b"\r\n\r\n"):
            answer += self.socket.recv(1)
        assert b" 101 " in answer, answer
        self.socket.setblocking(False)
        self.received, self.waiting, self.skip, self.frame = 0, bytearray(), 0, None
        self.ended = collections.deque()  # frames that frames() has not told

    def say(self, **message):
        data = json.dumps(message).encode()
        size = bytes([0x80 | len(data)])
        if len(data) >= 126:
            size = bytes([0xFE]) + len(data).to_bytes(2, "big")
        self.socket.sendall(bytes([0x81]) + size + bytes(4) + data)

    def open(self, mesh, fields):
        """Credit never stops it."""
        self.say(type="open", mesh=mesh, fields=fields, credit=1 << 50)

    def take(self):
        """Reads what is there; returns the frames that have ended."""
        try:
            data = self.socket.recv(READ_BYTES)
        except BlockingIOError:
            return []
        if not data:
            raise ConnectionError("the server has closed the connection")
        self.received += len(data)
        self.waiting += data
        out = []
        while self._step(time.monotonic()):
            if self.frame.ended:
                out.append(self.frame)
                self.frame = None
        return out

    def _step(self, now):
        """Takes a head, or some of what it announces. False: more must come first."""
        waiting = self.waiting
        if self.frame is None:
            long = {126: 2, 127: 8}.get(waiting[1] & 127, 0) if len(waiting) > 1 else 0
            if len(waiting) < 2 + long:
                return False
            size = int.from_bytes(waiting[2 : 2 + long], "big") if long else waiting[1] & 127
            first = self.received - len(waiting)
            self.frame = Frame(waiting[0] & 15, size, first, now)
            self.skip = size
            del waiting[: 2 + long]
        if self.frame.kind == BINARY:
            taken = min(self.skip, len(waiting))
            del waiting[:taken]
            self.skip -= taken
        elif len(waiting) >= self.skip:
            text = bytes(waiting[: self.skip])
            del waiting[: self.skip]
            self.skip = 0
            if self.frame.kind == TEXT:
                self.frame.text = json.loads(text)
        if self.skip:
            return False
        self.frame.ended = now
        return True

    def frames(self, until):
        """The frames that end before a time."""
        while (left := until - time.monotonic()) > 0:
            if not self.ended:
                select.select([self.socket], [], [], left)
                self.ended.extend(self.take())
            if self.ended:
                yield self.ended.popleft()

    def until(self, wanted, seconds):
        """The first frame that is `wanted`."""
        for frame in self.frames(time.monotonic() + seconds):
            if wanted(frame):
                return frame
        raise TimeoutError("not within %g s" % seconds)

    def close(self):
        self.socket.close()

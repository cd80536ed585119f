"""qtet-server on a port of its own choice, reached from all of a line's namespaces."""
import contextlib, json, re, subprocess, urllib.request


@contextlib.contextmanager
def running(program, folder, *options):
    """Yields the port and the first mesh: its name and its fields."""
    server = subprocess.Popen(
        [program, folder, "--host", "0.0.0.0", "--port", "0", *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        port = int(re.search(r":(\d+)/", server.stdout.readline())[1])
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/v1/meshes") as answer:
            mesh = json.load(answer)["meshes"][0]
        yield port, (mesh["id"], mesh["fields"])
    finally:
        server.terminate()
        server.wait()

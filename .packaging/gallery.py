"""A gallery for static hosting: the samples as a published folder, and a page with pictures that
links to each feature of the viewer.

   gallery.py FOLDER [BUILD]      after make build; the same build gives the same bytes
"""
import html
import pathlib
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Sample, title, and links: (text, what the viewer shows).
SAMPLES = (
    (
        "fin",
        "Supersonic flow round a swept fin",
        (
            ("Velocity in the middle plane", {"field": "Velocity", "clip": "y:0.5"}),
            (
                "The shock as isosurfaces",
                {"field": "Pressure", "iso": "Density=1.5,2.5", "surface": "off"},
            ),
            ("Density seen through", {"field": "Density", "volume": "auto"}),
            ("Only where the flow is slow", {"field": "Velocity", "threshold": "Velocity=0,1"}),
            (
                "An own field: the pressure coefficient",
                {"derived": "Cp = (Pressure - 1) / 2", "field": "Cp", "clip": "y:0.5"},
            ),
            ("Where density changes: its gradient", {"derived": "steep = mag(grad(Density))",
                                                     "field": "steep", "clip": "y:0.5"}),
            ("The first 30 kB of 434", {"field": "Density", "quality": "bytes:30000"}),
        ),
    ),
    (
        "elbow",
        "Flow through a bent pipe",
        (
            ("Speed in a slice", {"field": "Velocity", "clip": "z:0.5", "clip-mode": "slice"}),
            (
                "One component, symmetric colours",
                {"field": "Velocity[1]", "colormap": "cool-warm", "range": "symmetric",
                 "clip": "z:0.5"},
            ),
            ("Vorticity in a slice", {"field": "Velocity.vorticity", "clip": "z:0.5",
                                      "clip-mode": "slice"}),
            ("Arrows on a cut", {"arrows": "Velocity", "field": "Pressure", "clip": "y:0.5",
                                 "arrow-size": "2.5"}),
            ("Streamlines", {"streamlines": "Velocity", "field": "Velocity", "opacity": "0.15",
                             "edges": "off"}),
            ("Moving dashes from a plane", {"streamlines": "Velocity", "field": "Velocity",
                                            "seeds": "plane x:0.05 8", "opacity": "0.1",
                                            "edges": "off", "streamline-look": "dashes"}),
            (
                "Kept points and a kept line",
                {"points": "Inlet: -2,0,0; Bend: 1,0.4,0; Outlet: 1.4,3,0",
                 "lines": "Across: 1,-0.3,0 1,0.9,0", "field": "Velocity", "clip": "z:0.5"},
            ),
            ("Pressure on the wall", {"field": "Pressure", "clip": "none"}),
        ),
    ),
    (
        "ball",
        "A planet's core, mantle and crust",
        (
            ("Layers: a field of cells", {"field": "Layer", "colormap": "labels", "clip": "y:0.5"}),
            ("Parts: the crust seen through", {"parts": "Layer", "part-opacity": "crust=0.3",
                                               "hidden-parts": "core", "clip": "y:0.5"}),
            (
                "Hot plumes",
                {"field": "Temperature", "iso": "Temperature=1500,2100", "surface": "off"},
            ),
            (
                "Whole cells behind two planes",
                {"field": "Temperature", "clip": "x:0.5 y:0.5", "clip-mode": "cells"},
            ),
        ),
    ),
    (
        "beam",
        "A loaded cantilever",
        (
            ("Von Mises stress", {"field": "VonMises", "colormap": "turbo"}),
            ("Its least and largest value", {"field": "VonMises", "extremes": "on"}),
            ("Cut lengthwise, logarithmic", {"field": "VonMises", "clip": "y:0.5", "scale": "log"}),
            ("Parallel, without edges", {"field": "Displacement", "edges": "off",
                                              "projection": "parallel"}),
        ),
    ),
    (
        "spring",
        "A coil spring",
        (
            ("Shear stress, cut open", {"field": "ShearStress", "clip": "z:0.6"}),
            ("Displacement", {"field": "Displacement", "colormap": "cividis"}),
        ),
    ),
    (
        "box",
        "A cube of 3,072 cells",
        (
            ("A plane in any direction", {"field": "Scalar", "clip": "1,1,1:0.5"}),
            ("Isosurfaces in a faint surface", {"field": "Scalar", "iso": "Scalar=0,1",
                                                "opacity": "0.2"}),
        ),
    ),
)

STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 72rem; margin: 0 auto; padding: 1.5rem; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(18rem, 1fr)); gap: 1.5rem; }
article { border: 1px solid color-mix(in srgb, currentColor 20%, transparent);
  border-radius: 12px; overflow: hidden; }
article > div { padding: 0 1rem 0.5rem; }
img { display: block; width: 100%; aspect-ratio: 16 / 10; object-fit: contain; }
h2 { font-size: 1.1rem; margin: 0.75rem 0 0.25rem; }
ul { padding-left: 1.2rem; margin: 0.25rem 0 0.5rem; }
p { max-width: 44rem; }
"""


def link(mesh, shown=None):
    return "view/?" + urllib.parse.urlencode({"mesh": mesh, **(shown or {})})


def article(mesh, title, links):
    items = "\n".join(
        f'        <li><a href="{html.escape(link(mesh, shown))}">{html.escape(text)}</a></li>'
        for text, shown in links
    )
    return f"""    <article>
      <a href="{html.escape(link(mesh))}"><img src="view/{mesh}.webp" alt="{mesh}"></a>
      <div>
        <h2>{html.escape(title)}</h2>
        <ul>
{items}
        </ul>
      </div>
    </article>
"""


def page():
    articles = "".join(article(*sample) for sample in SAMPLES)
    return f"""<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <meta name="viewport" content="width=device-width, initial-scale=1">
    <title>qtet gallery</title>
    <style>{STYLE}</style>
  </head>
  <body>
    <h1>qtet gallery</h1>
    <p>Tetrahedral meshes with their fields, whole at once and refined to the original. Each link
      opens the viewer on one view. Your own <code>.vtu</code>, <code>.vtk</code>,
      <code>.msh</code> or <code>.qtet</code> opens when you drop it there; it stays on your
      machine.</p>
    <main>
{articles}    </main>
  </body>
</html>
"""


def build_gallery(folder, build=ROOT / "build/release"):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    qtet = build / "bin/qtet"
    with tempfile.TemporaryDirectory(prefix="qtet-gallery-") as work:
        logs = []
        for mesh, _, _ in SAMPLES:
            source, log = pathlib.Path(work) / f"{mesh}.vtu", pathlib.Path(work) / f"{mesh}.qtet"
            for words in (("sample", mesh, "-o", source), ("simplify", source, "-o", log)):
                subprocess.run([qtet, *words], check=True, stdout=sys.stderr)
            logs.append(log)
        viewer = build / "share/qtet/viewer"
        words = [qtet, "publish", folder / "view", *logs, "--viewer", viewer]
        subprocess.run(words, check=True, stdout=sys.stderr)
    (folder / "index.html").write_text(page())


if __name__ == "__main__":
    build_gallery(*(pathlib.Path(word).resolve() for word in sys.argv[1:]))

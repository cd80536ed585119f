"""A program that reads a mesh file by another's library, and hands its steps to qtet.

Its words: the file, a folder for what it writes, the kind of file, a file beside it or nothing.
It says `times T ...`, then answers each number of a step that it is asked for: `block FILE NAME`
for each part of the mesh, in VTK's XML, then `done`. It may say `note TEXT` before that. A
`failed TEXT` ends it. foreign_file.h runs it; vtk.py or meshio.py follows this text.
"""

import os
import sys

NO_MODULE, NO_SUCH_KIND, NO_MEMORY = 77, 78, 3

# Python would look for modules in the working folder first, where a mesh's sender may have put one.
sys.path[:] = [folder for folder in sys.path if folder]
source, folder, kind, companion = sys.argv[1:5]
os.chdir(os.path.dirname(source))  # libraries look there for the files that this one names
asked = os.fdopen(os.dup(0), "rb")
answers = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)  # whatever a library prints is no answer


def say(word, *texts):
    line = "\t".join(" ".join(str(text).split()) for text in texts)
    answers.write((word + " " + line + "\n").encode(errors="replace"))
    answers.flush()


def fail(text):
    say("failed", text)
    sys.exit(0)


def serve(times, write_step):
    """Writes the steps that are asked for; one, number 0, where there are no times."""
    say("times", *[repr(float(time)) for time in times])
    for line in asked:
        write_step(int(line))
        say("done")

#include "simplify/read/run_meshio.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>

#include "simplify/read/guarded_folder.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr int kNoProgram = 127, kNoMeshio = 77;  ///< what the child ends with
/// Reads, drops what a .vtu cannot hold, and writes. Python would look for meshio in the working
/// folder first, where a mesh's sender may have put one.
constexpr const char* kScript =
    "import sys\n"
    "sys.path[:] = [folder for folder in sys.path if folder]\n"
    "try:\n"
    "    import meshio\n"
    "except ImportError:\n"
    "    sys.exit(77)\n"
    "try:\n"
    "    mesh = meshio.read(sys.argv[1])\n"
    "    mesh.cell_sets, mesh.point_sets, mesh.field_data, mesh.info = {}, {}, {}, None\n"
    "    meshio.write(sys.argv[2], mesh, file_format='vtu', binary=True)\n"
    "except SystemExit:\n"  // it has said why
    "    sys.exit(1)\n"
    "except BaseException as error:\n"
    "    sys.stderr.write('\\n' + (str(error) or type(error).__name__).replace('\\n', ' '))\n"
    "    sys.exit(1)\n";

/// What the program ends with; -1: it was killed, or could not be started.
int run(const char* python, const fs::path& in, const fs::path& out, const fs::path& words) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would wait for it
    const int file = ::open(words.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
              nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execlp(python, python, "-c", kScript, in.c_str(), out.c_str(), static_cast<char*>(nullptr));
    ::_exit(kNoProgram);
  }
  if (child < 0) return -1;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string lastLineOf(const fs::path& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last.empty() ? "it ended without a word" : last;
}

}  // namespace

Status throughMeshio(const fs::path& path, const std::function<Status(const fs::path&)>& use) {
  const GuardedFolder folder("meshio");
  if (folder.failure())
    return fail(ErrorCode::kIo, "no temporary folder could be made (" + folder.failure().message() +
                                    "); let TMPDIR name one with room");
  const fs::path out = folder.path() / "mesh.vtu", words = folder.path() / "words.txt";
  // The first python3 may be one of the user's own; Debian's has Debian's meshio.
  int ended = kNoProgram;
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    ended = run(python, fs::absolute(path), out, words);
    if (ended != kNoProgram && ended != kNoMeshio) break;
  }
  if (ended == kNoProgram || ended == kNoMeshio) {
    return fail(ErrorCode::kNotFound, path.string() + ": files of type '" +
                                          path.extension().string() +
                                          "' are read through meshio, which is not installed; "
                                          "install it (apt install python3-meshio, or pip install "
                                          "meshio), or save the mesh as .vtu");
  }
  if (ended != 0)
    return fail(ErrorCode::kBadInput, path.string() + ": meshio could not read it: " +
                                          lastLineOf(words) + "; save the mesh as .vtu");
  return use(out);
}

}  // namespace qtet

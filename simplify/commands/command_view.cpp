// `qtet view`: a log, or a log made of a mesh, behind a server of its own on a free port, and the
// browser on it.
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "simplify/commands/commands.h"
#include "simplify/commands/provided_log.h"
#include "simplify/commands/tool_main.h"
#include "simplify/log/opened_list.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// qtet-server beside this program, else what PATH has.
std::string serverProgram() {
  std::error_code code;
  const fs::path beside = installation().programs / "qtet-server";
  return fs::exists(beside, code) ? beside.string() : "qtet-server";
}

volatile std::sig_atomic_t serverProcess = 0;

/// A Ctrl-C reaches the server, too, but a signal for this process alone does not.
extern "C" void passOn(int) {
  if (serverProcess > 0) ::kill(static_cast<pid_t>(serverProcess), SIGTERM);
}

/// The server's standard output; its process in serverProcess. -1: no pipe or process could be
/// made.
int startServer(const fs::path& folder, const std::string& port) {
  const std::string program = serverProgram();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::dup2(ends[1], STDOUT_FILENO);
    ::execlp(program.c_str(), program.c_str(), folder.c_str(), "--port", port.c_str(),
             static_cast<char*>(nullptr));
    constexpr std::string_view kMissing =
        "qtet: qtet-server is not installed beside qtet nor found in PATH; install it (Debian "
        "package qtet-server)\n";
    (void)!::write(STDERR_FILENO, kMissing.data(), kMissing.size());
    ::_exit(kExitFailed);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return -1;
  }
  serverProcess = child;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action{};
    action.sa_handler = passOn;
    action.sa_flags = SA_RESTART;
    ::sigaction(number, &action, nullptr);
  }
  return ends[0];
}

void openBrowser(const std::string& url) {
  const pid_t child = ::fork();
  if (child != 0) {
    if (child > 0) ::waitpid(child, nullptr, 0);
    return;
  }
  if (::fork() != 0) ::_exit(0);  // the grandchild is nobody's to wait for
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  ::execlp("xdg-open", "xdg-open", url.c_str(), static_cast<char*>(nullptr));
  ::_exit(1);
}

bool onDesktop() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// "http://127.0.0.1:4711/" of "qtet-server: listening on http://127.0.0.1:4711/ (1 mesh)"; empty
/// for other lines.
std::string urlIn(const std::string& line) {
  constexpr std::string_view kBefore = "listening on ";
  const std::size_t at = line.find(kBefore);
  if (at == std::string::npos) return {};
  const std::size_t from = at + kBefore.size();
  return line.substr(from, line.find(' ', from) - from);
}

/// Returns when the server ends. The server's words are shown on request.
void followServer(int words, const std::string& name, bool open, Console& console) {
  std::string line;
  bool told = false;
  char piece[4096];
  for (ssize_t got = 0; (got = ::read(words, piece, sizeof piece)) > 0;) {
    for (const char c : std::string_view(piece, static_cast<std::size_t>(got))) {
      if (c != '\n') {
        line += c;
        continue;
      }
      const std::string url = told ? "" : urlIn(line);
      if (!url.empty()) {
        told = true;
        console.out << url << "?mesh=" << name << std::endl;
        console.err << "qtet: Ctrl-C stops\n";
        if (open) openBrowser(url + "?mesh=" + name);
      } else if (console.verbose) {
        console.err << printable(line) << "\n";
      }
      line.clear();
    }
  }
}

CommandHelp viewHelp() {
  return {
      "view", "view FILE [options]",
      R"(Shows a log in the browser, or a mesh after simplifying it with the usual settings into a
temporary log.
Serves it on this machine alone until Ctrl-C, prints the URL, and opens it where there is a desktop.
To keep the log: qtet simplify, then qtet-server.)",
      R"(  qtet view part.vtu
  qtet view part.qtet --port 8080 --no-open
  qtet view run.pvd --time 0.5 --fields p,U
)"};
}

}  // namespace

int runView(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("port", po::value<int>()->default_value(0),
                        "TCP port on 127.0.0.1; 0 = any free one")(
      "no-open", "only print the URL, also on a desktop")(
      "fields", po::value<std::string>()->default_value("all"),
      "of a mesh: all, none, or names between commas, as `qtet simplify --fields` takes them");
  addReadOptions(options);
  const ParsedWords parsed(words, viewHelp(), options, {"FILE"});
  if (parsed.helped(console)) return kExitOk;
  const fs::path input = parsed.get<std::string>("FILE");
  const std::string port = std::to_string(parsed.integer("port", 0, 65535));
  if (isSegmentList(input))
    throw UsageError("'" + input.string() +
                     "' is a list of logs, which qtet-server does not give; 'qtet publish FOLDER " +
                     input.filename().string() + "' makes a folder for any web server");
  const GuardedFolder folder("view");
  if (Status made = folder.made(); !made) return reportFailure(made.error(), false, console);
  const std::string name = meshNameOf(input);
  if (const int made = provideLog(input, folder.path() / (name + ".qtet"), parsed, console);
      made != kExitOk)
    return made;

  const int said = startServer(folder.path(), port);
  if (said < 0)
    return reportFailure(
        {ErrorCode::kIo, "the server cannot be started; are there too many processes?",
         Error::kNoOffset},
        false, console);
  followServer(said, name, !parsed.has("no-open") && onDesktop(), console);
  ::close(said);
  int status = 0;
  ::waitpid(static_cast<pid_t>(serverProcess), &status, 0);
  serverProcess = 0;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? kExitOk : kExitFailed;
}

}  // namespace qtet

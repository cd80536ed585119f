// qtet-server: wires the store, the viewer's files and the server together, and turns failures into exit codes.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "server/command_line.h"
#include "server/server.h"

namespace {

using namespace qtet;
namespace fs = std::filesystem;

constexpr int kCannotServe = 1;
constexpr int kWrongUsage = 2;

/// A socket a connection: the usual soft limit of 1,024 files is far below what the server is made for.
void raiseFileLimit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

/// The folder given, which must hold a viewer, or the one beside the program, which need not.
Result<ViewerFiles> loadViewer(const CommandLine& wishes) {
  if (wishes.viewer) return ViewerFiles::load(*wishes.viewer);
  std::error_code ec;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ec).parent_path() / "../share/qtet/viewer";
  if (ec || !fs::exists(beside / "index.html", ec)) return ViewerFiles();
  return ViewerFiles::load(beside);
}

int cannotServe(const Error& error) {
  std::cerr << "qtet-server: " << error.message << "\n";
  return kCannotServe;
}

int serve(const CommandLine& wishes) {
  raiseFileLimit();
  const Result<MeshStore> store = MeshStore::open(wishes.folder);
  if (!store) return cannotServe(store.error());
  for (const MeshStore::Refused& refused : store->refused())
    spdlog::error("{} is not served: {}", refused.path.string(), refused.error.text());
  for (const auto& [id, mesh] : store->meshes())
    spdlog::info("{}: {} tetrahedra in {} levels, {} bytes", id, mesh.manifest.levels.back().tetrahedra, mesh.manifest.levels.size(),
                 mesh.log.bytes().size());
  const Result<ViewerFiles> viewer = loadViewer(wishes);
  if (!viewer) return cannotServe(viewer.error());
  if (viewer->empty()) spdlog::info("no viewer found; build it or name it with --viewer DIR, the API works without");

  Server server(*store, *viewer, {.host = wishes.host, .port = wishes.port, .threads = wishes.threads, .endOnSignals = true});
  if (const Status listening = server.listen(); !listening) return cannotServe(listening.error());
  const std::size_t count = store->meshes().size();
  std::cout << "qtet-server: listening on " << server.url() << " (" << count << (count == 1 ? " mesh)" : " meshes)") << std::endl;
  server.run();
  return 0;
}

int run(int argc, char** argv) {
  const Result<CommandLine> wishes = parseCommandLine(argc, argv);
  if (!wishes) {
    std::cerr << "qtet-server: " << wishes.error().message << "\n\n" << usageText();
    return kWrongUsage;
  }
  switch (wishes->wish) {
    case CommandLine::Wish::kHelp: std::cout << usageText(); return 0;
    case CommandLine::Wish::kVersion: std::cout << "qtet-server " QTET_VERSION "\n"; return 0;
    case CommandLine::Wish::kServe: break;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt("qtet-server"));
  return serve(*wishes);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "qtet-server: %s\n", e.what());
    return kCannotServe;
  }
}

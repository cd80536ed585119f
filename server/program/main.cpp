// qtet-server: wires the store, the viewer's files and the server together, and turns failures into
// exit codes.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <thread>

#include "codec/files/temporary_folder.h"
#include "proto/version.h"
#include "server/decode/decoder_main.h"
#include "server/decode/decoders.h"
#include "server/program/command_line.h"
#include "server/program/server.h"
#include "server/store/bus_guard.h"
#include "server/store/folder_watch.h"
#include "server/store/level_cache.h"
#include "server/store/store_limits.h"

namespace {

using namespace qtet;
namespace fs = std::filesystem;

constexpr int kCannotServe = 1;
constexpr int kWrongUsage = 2;
/// In the folder of the logs, hidden.
constexpr const char* kTicketKey = ".qtet-tickets.key";

/// A socket a connection: the usual soft limit of 1,024 files is far below what the server is made
/// for.
void raiseFileLimit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

/// The folder given, which must hold a viewer, or the one beside the program, which need not.
Result<ViewerFiles> loadViewer(const CommandLine& options) {
  if (options.viewer) return ViewerFiles::load(*options.viewer);
  std::error_code ec;
  const fs::path beside =
      fs::read_symlink("/proc/self/exe", ec).parent_path() / "../share/qtet/viewer";
  if (ec || !fs::exists(beside / "index.html", ec)) return ViewerFiles();
  return ViewerFiles::load(beside);
}

int cannotServe(const Error& error) {
  std::cerr << "qtet-server: " << error.message << "\n";
  return kCannotServe;
}

/// Where finished levels lie: where --cache says, or in systemd's cache folder; nullopt: in a
/// temporary one.
std::optional<fs::path> wantedCache(const CommandLine& options) {
  const char* ofSystemd = std::getenv("CACHE_DIRECTORY");
  return options.cache || ofSystemd == nullptr ? options.cache : std::optional(fs::path(ofSystemd));
}

template <class Files>
void logRefused(const Files& refused) {
  for (const RefusedPointer& file : refused)
    spdlog::error("{} is not served: {}", file->path.string(), file->error.text());
}

void logChange(const FolderChange& change) {
  if (change.added.size() > limits::kMaxLoggedMeshes)
    spdlog::info("{} logs more are served", change.added.size());
  else
    for (const EntryPointer& mesh : change.added)
      spdlog::info("{}: {} tetrahedra in {} levels, {} bytes", mesh->id, mesh->tetrahedra,
                   mesh->levels, mesh->bytes);
  for (const std::string& id : change.removed) spdlog::info("{}: removed", id);
  logRefused(change.refused);
}

void lookAgain(const MeshStore& store) {
  const Result<FolderChange> change = store.rescan();
  if (!change) return spdlog::error("{}; what was served is served on", change.error().message);
  logChange(*change);
}

/// Reads what the start and the watch have left unread, beside the serving: at most half of the
/// time and after the threads that serve.
std::jthread readOn(const MeshStore& store) {
  return std::jthread([&store](const std::stop_token& stop) {
    (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), limits::kReadingNiceness);
    using Clock = std::chrono::steady_clock;
    Clock::duration rest{};
    while (store.awaitUnread(stop, rest)) {
      const Clock::time_point began = Clock::now();
      const Result<FolderChange> change = store.readOn();
      if (change) logChange(*change);
      if (!change) spdlog::error("{}; what was served is served on", change.error().message);
      rest = change ? std::max<Clock::duration>(limits::kFolderReadRest, Clock::now() - began)
                    : limits::kFolderInterval;
    }
  });
}

/// Makes what the viewer's folder lacks beside the serving, after the threads that serve.
std::jthread compressRest(ViewerFiles& viewer) {
  return std::jthread([&viewer](const std::stop_token& stop) {
    (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), limits::kReadingNiceness);
    viewer.compressRest(stop);
  });
}

Result<std::optional<FolderWatch>> watchFolder(const CommandLine& options, const MeshStore& store) {
  if (!options.watch) return std::optional<FolderWatch>();
  Result<FolderWatch> watch = FolderWatch::start(options.folder, [&store] { lookAgain(store); });
  if (!watch) return std::unexpected(watch.error());
  return std::optional<FolderWatch>(std::move(*watch));
}

/// The secrets that SIGHUP reloads; nullptr: there is none.
struct Secrets {
  std::unique_ptr<Access> access{};
  std::unique_ptr<CurrentTls> tls{};
};

/// The key that all servers of the folder share. If the server cannot write there, its tickets are
/// valid for itself only.
Result<std::string> ticketKeyOf(const CommandLine& options) {
  if (options.action == CommandLine::Action::kCheckConfig && !options.ticketKey)
    return std::string();
  Result<std::string> out = loadTicketKey(options.ticketKey.value_or(options.folder / kTicketKey));
  if (out || options.ticketKey || out.error().code != ErrorCode::kIo) return out;
  spdlog::info("{}; tickets are for this server alone", out.error().message);
  return std::string();
}

Result<Secrets> loadSecrets(const CommandLine& options) {
  Secrets out;
  if (options.tokens) {
    Result<Tokens> tokens = Tokens::load(*options.tokens);
    if (!tokens) return std::unexpected(tokens.error());
    const Result<std::string> key = ticketKeyOf(options);
    if (!key) return std::unexpected(key.error());
    out.access = std::make_unique<Access>(std::move(*tokens), *key);
  }
  if (options.tlsCertificate) {
    auto context = TlsContext::load(*options.tlsCertificate, *options.tlsKey);
    if (!context) return std::unexpected(context.error());
    out.tls = std::make_unique<CurrentTls>(std::move(*context));
  }
  return out;
}

/// Handles SIGHUP: reads the secrets again. If one is invalid, logs the reason and keeps the old
/// ones.
void reload(const CommandLine& options, const Secrets& secrets) {
  if (!secrets.access && !secrets.tls)
    return spdlog::info("SIGHUP: there are no tokens and no certificate to read again");
  Result<Secrets> read = loadSecrets(options);
  if (!read)
    return spdlog::error(
        "SIGHUP: {}; the tokens and the certificate that were read before are kept",
        read.error().message);
  if (secrets.access && secrets.access->tokens()->guardReading() &&
      !read->access->tokens()->guardReading())
    return spdlog::error(
        "SIGHUP: {} has no line that begins with read any more, which would open every mesh; if "
        "that is meant, write 'read * anyone'. The tokens that were read before are kept",
        options.tokens->string());
  if (secrets.access) secrets.access->replace(*read->access->tokens());
  if (secrets.tls) secrets.tls->replace(read->tls->now());
  spdlog::info("SIGHUP: the tokens and the certificate were read again");
}

/// After a rotation.
void reopen(AccessLog* log) {
  if (log == nullptr) return;
  if (const Status done = log->reopen(); !done)
    return spdlog::error("{}; the file that was open before is kept", done.error().message);
  spdlog::info("the access log was opened again");
}

ServerOptions serverOptions(const CommandLine& options, LevelCache* cache, AccessLog* accessLog,
                            const Secrets& secrets) {
  return {.host = options.host,
          .port = options.port,
          .threads = options.threads,
          .maxConnections = options.maxConnections,
          .maxConnectionsPerAddress = options.maxConnectionsPerAddress,
          .maxRequestsPerSecond = options.maxRequestsPerSecond,
          .maxLevelsPerAddress = options.maxLevelsPerAddress,
          .maxLevelBytes = options.maxLevelBytes,
          .adminHost = options.adminHost,
          .adminPort = options.adminPort,
          .readyEarly = options.readyEarly,
          .endOnSignals = true,
          .cache = cache,
          .accessLog = accessLog,
          .tls = secrets.tls.get(),
          .access = secrets.access.get(),
          .reload =
              [&options, &secrets, accessLog] {
                reload(options, secrets);
                reopen(accessLog);
              },
          .reopenLog = [accessLog] { reopen(accessLog); },
          .allowedOrigins = options.allowedOrigins,
          .frameAncestors = options.frameAncestors,
          .proxies = options.proxies,
          .uploads = {.maxBytes = options.maxUploadBytes,
                      .checkLimits = {options.maxCheckBytes, options.maxCheckTime},
                      .parts = {.reserve = options.diskReserve}},
          .drain = options.drainTime};
}

int serve(const CommandLine& options) {
  raiseFileLimit();
  guardAgainstBusErrors();
  const Result<MeshStore> store = MeshStore::open(options.folder);
  if (!store) return cannotServe(store.error());
  const CataloguePointer catalogue = store->catalogue();
  logRefused(catalogue->refused);
  Result<ViewerFiles> viewer = loadViewer(options);
  if (!viewer) return cannotServe(viewer.error());
  if (viewer->empty())
    spdlog::info("no viewer found; build it or name it with --viewer DIR, the API works without");
  std::optional<TemporaryFolder> temporary;
  const std::optional<fs::path> cacheFolder = wantedCache(options);
  if (!cacheFolder) temporary.emplace("server");
  const Result<std::unique_ptr<LevelCache>> cache =
      LevelCache::open(cacheFolder.value_or(temporary ? temporary->path() : fs::path()),
                       options.cacheBytes, options.diskReserve);
  if (!cache) return cannotServe(cache.error());
  Result<std::unique_ptr<AccessLog>> accessLog = nullptr;
  if (options.accessLog) accessLog = AccessLog::open(*options.accessLog);
  if (!accessLog) return cannotServe(accessLog.error());

  const Result<Secrets> secrets = loadSecrets(options);
  if (!secrets) return cannotServe(secrets.error());

  Decoders decoders(
      {.processes = limits::kLevelThreads + limits::kPointThreads + limits::kCheckThreads,
       .levelBytes = options.maxLevelBytes});
  ServerOptions wired = serverOptions(options, cache->get(), accessLog->get(), *secrets);
  wired.decoders = &decoders;
  wired.uploads.check = [&decoders](const ServedMesh& mesh, const CheckLimits& limits,
                                    const std::stop_token& stop) {
    return decoders.check(mesh, limits, stop);
  };
  Server server(*store, *viewer, std::move(wired));
  if (const Status listening = server.listen(); !listening) return cannotServe(listening.error());
  const Result<std::optional<FolderWatch>> watch = watchFolder(options, *store);
  if (!watch) return cannotServe(watch.error());
  const std::size_t count = catalogue->meshes.size() + catalogue->unread.size();
  std::cout << "qtet-server: listening on " << server.url() << " (" << count
            << (count == 1 ? " mesh" : " meshes")
            << (catalogue->named ? ")" : ", more names are being read)") << std::endl;
  if (options.adminHost)
    std::cout << "qtet-server: operators' address is " << *options.adminHost << ":"
              << server.adminPort() << std::endl;
  const std::jthread reading = readOn(*store);
  const std::jthread compressing = compressRest(*viewer);
  server.run();
  return 0;
}

/// Checks folder, viewer and secrets as serve() does, without serving.
int checkConfig(const CommandLine& options) {
  std::cout << configText(options);
  std::error_code ec;
  if (!fs::is_directory(options.folder, ec))
    return cannotServe({ErrorCode::kIo,
                        options.folder.string() + " is no folder; name one that holds .qtet files",
                        Error::kNoOffset});
  if (const Result<ViewerFiles> viewer = loadViewer(options); !viewer)
    return cannotServe(viewer.error());
  if (const Result<Secrets> secrets = loadSecrets(options); !secrets)
    return cannotServe(secrets.error());
  return 0;
}

int run(int argc, char** argv) {
  const Result<CommandLine> options = parseCommandLine(argc, argv, environ);
  if (!options) {
    std::cerr << "qtet-server: " << options.error().message
              << "\nqtet-server: see 'qtet-server --help'\n";
    return kWrongUsage;
  }
  switch (options->action) {
    case CommandLine::Action::kHelp: std::cout << usageText(false); return 0;
    case CommandLine::Action::kHelpAll: std::cout << usageText(true); return 0;
    case CommandLine::Action::kVersion: std::cout << "qtet-server " << version() << '\n'; return 0;
    case CommandLine::Action::kCheckConfig: return checkConfig(*options);
    case CommandLine::Action::kServe: break;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt("qtet-server"));
  return serve(*options);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == kDecoderArgument) runDecoder();
  // until the server listens to them: what is meant for a running one must not end it
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGUSR1, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "qtet-server: %s\n", e.what());
    return kCannotServe;
  }
}

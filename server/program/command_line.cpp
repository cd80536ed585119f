#include "server/program/command_line.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <charconv>
#include <fstream>
#include <sstream>
#include <thread>

#include "proto/option_error.h"

namespace qtet {
namespace {

namespace po = boost::program_options;

constexpr std::size_t kMaxThreads = 256;
constexpr std::string_view kPrefix = "QTET_SERVER_";

std::size_t defaultThreads() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMaxThreads);
}

/// Options allowed in all three places: command line, environment and configuration file. Those of
/// the first group are in --help, the others in --help-all.
std::vector<po::options_description> settingGroups() {
  std::vector<po::options_description> groups;
  const auto group = [&](const char* title) { return groups.emplace_back(title).add_options(); };
  const auto text = [] { return po::value<std::string>(); };
  group(
      "Settings, also in the environment (--access-log as QTET_SERVER_ACCESS_LOG) and in the file\n"
      "of --config")("folder", text(),
                     "folder that holds the .qtet files (may be given without its name)")(
      "host", text(), "address to listen on; 0.0.0.0 = every network (default: 127.0.0.1)")(
      "port", text(), "TCP port; 0 = any free one (default: 8080)")(
      "tls-certificate", text(),
      "PEM file, its own certificate first: HTTPS instead of HTTP (default: none)")(
      "tls-key", text(), "PEM file of its key")(
      "tokens", text(),
      "file of bearer tokens that may read, PUT and DELETE meshes (default: everybody may read, "
      "nobody change)")("cache", text(),
                        "folder for finished levels (default: $CACHE_DIRECTORY, else a temporary "
                        "one)")("access-log", text(),
                                "file for a line of JSON a request; - = standard output")(
      "trust-proxy", text(),
      "addresses and blocks between commas, like 10.0.0.0/8, of proxies that may say for whom "
      "they ask; the bounds of an address and the access log heed it (default: none)");
  group("Running")("threads", text(), "threads for connections (default: one a core)")(
      "watch", text(), "on, off: whether logs that come, change and go are noticed (default: on)")(
      "ready-early", text(),
      "on, off: whether /readyz is 200 before the folder's names are known (default: off)")(
      "cache-bytes", text(), "how much the cache may hold (default: 2 GiB)")(
      "viewer", text(),
      "folder of the built viewer (default: ../share/qtet/viewer beside this program)")(
      "admin", text(),
      "HOST:PORT where alone /livez, /readyz, /metrics and /version are answered (default: beside "
      "everything else)")(
      "drain-seconds", text(),
      "how long /readyz is 503, and all is served, between SIGTERM and the end (default: 0)")(
      "ticket-key", text(),
      "file of the key that signs tickets, the same for servers of one folder (default: "
      ".qtet-tickets.key in the folder, which is made)");
  group("Uploads")("max-upload-bytes", text(), "the largest log that is taken (default: 16 GiB)")(
      "max-check-bytes", text(),
      "memory that checking an upload may take; more is 413 (default: 4 GiB)")(
      "max-check-seconds", text(), "time that it may take (default: 600)")(
      "disk-reserve-bytes", text(),
      "of the disk below which no upload is begun and no level kept (default: 256 MiB)");
  group("Limits")("max-connections", text(), "at a time, in all (default: 4000)")(
      "max-connections-per-address", text(),
      "at a time; 0 = no bound, as behind a proxy (default: 256)")(
      "max-level-bytes", text(),
      "memory that making one level may take; more is 413 (default: a quarter of the memory)")(
      "max-levels-per-address", text(),
      "made or waiting at a time; 0 = no bound, as behind a proxy (default: 6)")(
      "max-requests-per-second", text(),
      "of one address, which may also owe 30 s of processor time beyond 0.2 s a second; 0 = "
      "neither bound, as behind a proxy (default: 2000)");
  group("Other pages and proxies")(
      "allow-origins", text(),
      "origins between commas, like https://viewer.example, whose pages may open streams, ask "
      "for tickets and change meshes (default: any)")(
      "frame-ancestors", text(),
      "pages that may show the viewer in a frame, as CSP writes them: * , 'none', 'self' "
      "https://a.example (default: *)")(
      "proxy-header", text(),
      "how the proxies of --trust-proxy say it: x-forwarded-for, forwarded (RFC 7239), or "
      "proxy-protocol (version 2) (default: x-forwarded-for)");
  return groups;
}

po::options_description settings() {
  po::options_description out;
  for (const po::options_description& group : settingGroups()) out.add(group);
  return out;
}

po::options_description commands() {
  po::options_description out("Commands");
  out.add_options()("config", po::value<std::string>(), "file of settings, lines NAME = VALUE")(
      "check-config", "print every setting as it holds, and end")(
      "help", "this text, with the settings that most need")("help-all", "every setting")(
      "version", "the version");
  return out;
}

/// The settings of the map as numbers and words; the first that is wrong is the error.
class Reader {
 public:
  explicit Reader(const po::variables_map& values) : values_(values) {}

  [[nodiscard]] std::optional<std::string> text(const char* name) const {
    if (!values_.contains(name)) return std::nullopt;
    return values_[name].as<std::string>();
  }
  template <class T>
  void number(const char* name, T& out, std::uint64_t least, std::uint64_t most) {
    const std::optional<std::string> given = text(name);
    if (!given) return;
    std::uint64_t value = 0;
    const auto [end, ec] = std::from_chars(given->data(), given->data() + given->size(), value);
    if (ec != std::errc() || end != given->data() + given->size() || value < least || value > most)
      return refuse("--" + std::string(name) + " " + *given + " is not between " +
                    std::to_string(least) + " and " + std::to_string(most));
    out = static_cast<T>(value);
  }
  void seconds(const char* name, std::chrono::seconds& out, std::uint64_t least,
               std::uint64_t most) {
    auto count = out.count();
    number(name, count, least, most);
    out = std::chrono::seconds(count);
  }
  void path(const char* name, std::optional<std::filesystem::path>& out) const {
    if (const auto given = text(name)) out = *given;
  }
  void flag(const char* name, bool& out) {
    const std::optional<std::string> given = text(name);
    if (!given) return;
    if (*given != "on" && *given != "off")
      return refuse("--" + std::string(name) + " is on or off, not " + *given);
    out = *given == "on";
  }
  void refuse(std::string message) {
    if (!error_) error_ = Error{ErrorCode::kBadValue, std::move(message), Error::kNoOffset};
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  const po::variables_map& values_;
  std::optional<Error> error_;
};

void readAdmin(Reader& reader, CommandLine& out) {
  const std::optional<std::string> given = reader.text("admin");
  if (!given) return;
  const std::size_t colon = given->rfind(':');
  const std::string port = colon == std::string::npos ? "" : given->substr(colon + 1);
  unsigned value = 0;
  const auto [end, ec] = std::from_chars(port.data(), port.data() + port.size(), value);
  if (port.empty() || ec != std::errc() || end != port.data() + port.size() || value > 65535 ||
      colon == 0)
    return reader.refuse("--admin " + *given + " is not HOST:PORT, like 127.0.0.1:9180");
  out.adminHost = given->substr(0, colon);
  if (out.adminHost->starts_with('[') && out.adminHost->ends_with(']'))
    out.adminHost = out.adminHost->substr(1, out.adminHost->size() - 2);
  out.adminPort = static_cast<std::uint16_t>(value);
}

void readOrigins(Reader& reader, CommandLine& out) {
  std::istringstream list(reader.text("allow-origins").value_or(""));
  for (std::string origin; std::getline(list, origin, ',');) {
    const std::size_t host = origin.find("://");
    if (host == std::string::npos || host == 0 || host + 3 == origin.size() ||
        origin.find('/', host + 3) != std::string::npos || origin.find(' ') != std::string::npos)
      return reader.refuse("--allow-origins: '" + origin +
                           "' is not SCHEME://HOST or SCHEME://HOST:PORT, without a path");
    out.allowedOrigins.push_back(std::move(origin));
  }
}

void readFrameAncestors(Reader& reader, CommandLine& out) {
  out.frameAncestors = reader.text("frame-ancestors").value_or(out.frameAncestors);
  const bool odd = std::ranges::any_of(
      out.frameAncestors, [](char c) { return c < ' ' || c > '~' || c == ';' || c == ','; });
  if (odd || out.frameAncestors.empty())
    reader.refuse("--frame-ancestors " + out.frameAncestors +
                  " is no list of sources between spaces, like 'self' https://a.example");
}

constexpr std::array<std::pair<std::string_view, ProxyHeader>, 3> kProxyHeaders{
    {{"x-forwarded-for", ProxyHeader::kForwardedFor},
     {"forwarded", ProxyHeader::kForwarded},
     {"proxy-protocol", ProxyHeader::kProxyProtocol}}};

void readProxies(Reader& reader, CommandLine& out) {
  out.proxyList = reader.text("trust-proxy").value_or("");
  Result<Networks> networks = Networks::parse(out.proxyList);
  if (!networks) return reader.refuse("--trust-proxy: " + networks.error().message);
  out.proxies.networks = std::move(*networks);
  const std::string header = reader.text("proxy-header").value_or("x-forwarded-for");
  const auto at =
      std::ranges::find(kProxyHeaders, header, &decltype(kProxyHeaders)::value_type::first);
  if (at == kProxyHeaders.end())
    return reader.refuse("--proxy-header " + header +
                         " is neither x-forwarded-for nor forwarded nor proxy-protocol");
  if (reader.text("proxy-header") && out.proxies.networks.empty())
    return reader.refuse("--proxy-header counts only with --trust-proxy, which names the proxies");
  out.proxies.header = at->second;
}

Result<CommandLine> toCommandLine(const po::variables_map& values) {
  CommandLine out;
  if (values.contains("check-config")) out.action = CommandLine::Action::kCheckConfig;
  if (values.contains("help")) out.action = CommandLine::Action::kHelp;
  if (values.contains("help-all")) out.action = CommandLine::Action::kHelpAll;
  if (values.contains("version")) out.action = CommandLine::Action::kVersion;
  if (out.action != CommandLine::Action::kServe && out.action != CommandLine::Action::kCheckConfig)
    return out;
  Reader reader(values);
  if (!values.contains("folder"))
    return fail(ErrorCode::kBadValue, "name the folder that holds the .qtet files");
  out.folder = *reader.text("folder");
  out.host = reader.text("host").value_or(out.host);
  out.threads = defaultThreads();
  constexpr std::uint64_t kAny = std::uint64_t{1} << 62;
  reader.number("port", out.port, 0, 65535);
  reader.number("threads", out.threads, 1, kMaxThreads);
  reader.number("cache-bytes", out.cacheBytes, 0, kAny);
  reader.number("max-upload-bytes", out.maxUploadBytes, 1, kAny);
  reader.number("max-check-bytes", out.maxCheckBytes, 1, kAny);
  reader.seconds("max-check-seconds", out.maxCheckTime, 1, 1'000'000);
  reader.number("disk-reserve-bytes", out.diskReserve, 0, kAny);
  reader.seconds("drain-seconds", out.drainTime, 0,
                 static_cast<std::uint64_t>(limits::kMaxDrainTime.count()));
  reader.path("ticket-key", out.ticketKey);
  reader.number("max-connections", out.maxConnections, 1, 1'000'000);
  reader.number("max-connections-per-address", out.maxConnectionsPerAddress, 0, 1'000'000);
  reader.number("max-level-bytes", out.maxLevelBytes, 1, kAny);
  reader.number("max-levels-per-address", out.maxLevelsPerAddress, 0, 1'000'000);
  reader.number("max-requests-per-second", out.maxRequestsPerSecond, 0, 1'000'000'000);
  reader.flag("watch", out.watch);
  reader.flag("ready-early", out.readyEarly);
  reader.path("viewer", out.viewer);
  reader.path("cache", out.cache);
  reader.path("tokens", out.tokens);
  reader.path("tls-certificate", out.tlsCertificate);
  reader.path("tls-key", out.tlsKey);
  if (out.tlsCertificate.has_value() != out.tlsKey.has_value())
    reader.refuse("--tls-certificate and --tls-key are given together, or neither");
  out.accessLog = reader.text("access-log");
  readAdmin(reader, out);
  readOrigins(reader, out);
  readFrameAncestors(reader, out);
  readProxies(reader, out);
  if (reader.error()) return std::unexpected(*reader.error());
  return out;
}

/// The option that an environment variable means; "" where it is none of ours.
std::string optionOfVariable(const std::string& variable) {
  if (!variable.starts_with(kPrefix)) return "";
  std::string out = variable.substr(kPrefix.size());
  std::ranges::transform(out, out.begin(), [](unsigned char c) {
    return c == '_' ? '-' : static_cast<char>(std::tolower(c));
  });
  return out;
}

/// As boost::program_options would read them, but of a list that is given; an unknown name is an
/// error, for it is a misspelt one.
po::parsed_options parseEnvironment(const char* const* environment,
                                    const po::options_description& known) {
  po::parsed_options out(&known);
  for (; environment != nullptr && *environment != nullptr; ++environment) {
    const std::string entry = *environment;
    const std::size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = optionOfVariable(entry.substr(0, equals));
    if (name.empty()) continue;
    if (known.find_nothrow(name, false) == nullptr)
      throw po::error("the environment's " + entry.substr(0, equals) + " is no option");
    out.options.emplace_back(
        name, std::vector<std::string>{entry.substr(std::min(equals + 1, entry.size()))});
  }
  return out;
}

}  // namespace

Result<CommandLine> parseCommandLine(int argc, const char* const* argv,
                                     const char* const* environment) {
  const po::options_description inFile = settings();
  po::options_description all;
  all.add(inFile).add(commands());
  po::options_description inEnvironment;
  inEnvironment.add(inFile).add_options()("config", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("folder", 1);
  constexpr int kStyle =
      po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::variables_map values;  // what is stored first stays
    po::store(
        po::command_line_parser(argc, argv).options(all).positional(positional).style(kStyle).run(),
        values);
    po::store(parseEnvironment(environment, inEnvironment), values);
    if (values.contains("config")) {
      const auto path = values["config"].as<std::string>();
      std::ifstream file(path);
      if (!file) return fail(ErrorCode::kIo, "the file " + path + " of --config cannot be read");
      po::store(po::parse_config_file(file, inFile), values);
    }
    po::notify(values);
    return toCommandLine(values);
  } catch (po::error& e) {
    return fail(ErrorCode::kBadValue, optionErrorText<po::error_with_option_name>(e));
  }
}

std::string usageText(bool all) {
  std::ostringstream out;
  out << "Usage: qtet-server DIR [options]\n\nServes the .qtet files of DIR: levels of detail over "
         "HTTP, refinement over a WebSocket,\nand the viewer's page.\n\n";
  const std::vector<po::options_description> groups = settingGroups();
  for (const po::options_description& group : groups)
    if (all || &group == &groups.front()) out << group << "\n";
  out << commands()
      << "\nExit codes: 0 ended by SIGINT or SIGTERM, 1 cannot serve, 2 wrong usage.\n";
  return out.str();
}

std::string configText(const CommandLine& options) {
  std::ostringstream out;
  const auto path = [&](const char* name, const auto& value) {
    if (value) out << name << " = " << std::filesystem::path(*value).string() << "\n";
  };
  out << "folder = " << options.folder.string() << "\nhost = " << options.host
      << "\nport = " << options.port << "\n";
  if (options.adminHost) {
    const bool v6 = options.adminHost->find(':') != std::string::npos;
    out << "admin = " << (v6 ? "[" : "") << *options.adminHost << (v6 ? "]:" : ":")
        << options.adminPort << "\n";
  }
  path("viewer", options.viewer);
  out << "threads = " << options.threads << "\nwatch = " << (options.watch ? "on" : "off")
      << "\nready-early = " << (options.readyEarly ? "on" : "off") << "\n";
  path("cache", options.cache);
  out << "cache-bytes = " << options.cacheBytes << "\n";
  path("access-log", options.accessLog);
  path("tokens", options.tokens);
  path("tls-certificate", options.tlsCertificate);
  path("tls-key", options.tlsKey);
  path("ticket-key", options.ticketKey);
  out << "max-upload-bytes = " << options.maxUploadBytes
      << "\nmax-check-bytes = " << options.maxCheckBytes
      << "\nmax-check-seconds = " << options.maxCheckTime.count()
      << "\ndisk-reserve-bytes = " << options.diskReserve
      << "\ndrain-seconds = " << options.drainTime.count()
      << "\nmax-connections = " << options.maxConnections
      << "\nmax-connections-per-address = " << options.maxConnectionsPerAddress
      << "\nmax-level-bytes = " << options.maxLevelBytes
      << "\nmax-levels-per-address = " << options.maxLevelsPerAddress
      << "\nmax-requests-per-second = " << options.maxRequestsPerSecond << "\n";
  for (std::size_t i = 0; i < options.allowedOrigins.size(); ++i)
    out << (i == 0 ? "allow-origins = " : ",") << options.allowedOrigins[i];
  if (!options.allowedOrigins.empty()) out << "\n";
  out << "frame-ancestors = " << options.frameAncestors << "\n";
  if (!options.proxyList.empty()) {
    const auto at = std::ranges::find(kProxyHeaders, options.proxies.header,
                                      &decltype(kProxyHeaders)::value_type::second);
    out << "trust-proxy = " << options.proxyList << "\nproxy-header = " << at->first << "\n";
  }
  return out.str();
}

}  // namespace qtet

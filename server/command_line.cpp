#include "server/command_line.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <sstream>
#include <thread>

namespace qtet {
namespace {

namespace po = boost::program_options;

constexpr std::size_t kMaxThreads = 256;

po::options_description visibleOptions() {
  po::options_description out("Options");
  out.add_options()("host", po::value<std::string>()->default_value("127.0.0.1"), "address to listen on; 0.0.0.0 = every network")(
      "port", po::value<int>()->default_value(8080), "TCP port; 0 = any free one")(
      "viewer", po::value<std::string>(), "folder of the built viewer (default: ../share/qtet/viewer beside this program)")(
      "threads", po::value<int>(), "threads for connections (default: one a core)")("help", "this text")("version", "the version");
  return out;
}

std::size_t defaultThreads() { return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMaxThreads); }

Result<CommandLine> toCommandLine(const po::variables_map& values) {
  CommandLine out;
  if (values.contains("help")) out.wish = CommandLine::Wish::kHelp;
  if (values.contains("version")) out.wish = CommandLine::Wish::kVersion;
  if (out.wish != CommandLine::Wish::kServe) return out;
  if (!values.contains("folder")) return fail(ErrorCode::kBadValue, "name the folder that holds the .qtet files");
  const int port = values["port"].as<int>();
  if (port < 0 || port > 65535) return fail(ErrorCode::kBadValue, "--port " + std::to_string(port) + " is not between 0 and 65535");
  const int threads = values.contains("threads") ? values["threads"].as<int>() : static_cast<int>(defaultThreads());
  if (threads < 1 || threads > static_cast<int>(kMaxThreads))
    return fail(ErrorCode::kBadValue, "--threads " + std::to_string(threads) + " is not between 1 and " + std::to_string(kMaxThreads));
  out.folder = values["folder"].as<std::string>();
  out.host = values["host"].as<std::string>();
  out.port = static_cast<std::uint16_t>(port);
  out.threads = static_cast<std::size_t>(threads);
  if (values.contains("viewer")) out.viewer = values["viewer"].as<std::string>();
  return out;
}

}  // namespace

Result<CommandLine> parseCommandLine(int argc, const char* const* argv) {
  po::options_description all = visibleOptions();
  all.add_options()("folder", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("folder", 1);
  constexpr int kStyle = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::variables_map values;
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).style(kStyle).run(), values);
    po::notify(values);
    return toCommandLine(values);
  } catch (const po::error& e) {
    return fail(ErrorCode::kBadValue, e.what());
  }
}

std::string usageText() {
  std::ostringstream out;
  out << "Usage: qtet-server DIR [options]\n\nServes the .qtet files of DIR: levels of detail over HTTP, refinement over a WebSocket, and "
         "the viewer's page.\n\n"
      << visibleOptions() << "\nExit codes: 0 ended by SIGINT or SIGTERM, 1 cannot serve, 2 wrong usage.\n";
  return out.str();
}

}  // namespace qtet

// Fuzzes the server's options: arguments, an empty line, variables. Valid options, printed by
// `--check-config`, must parse to the same again.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "server/program/command_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> arguments{"qtet-server"}, variables;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  bool inEnvironment = false;
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('\0'));
    if (line.empty()) inEnvironment = true;
    if (line.find("config") != std::string::npos) continue;  // names files
    (inEnvironment ? variables : arguments).push_back(line);
  }
  std::vector<const char*> argv, environment;
  for (const std::string& a : arguments) argv.push_back(a.c_str());
  for (const std::string& v : variables) environment.push_back(v.c_str());
  environment.push_back(nullptr);
  const auto parsed =
      qtet::parseCommandLine(static_cast<int>(argv.size()), argv.data(), environment.data());
  if (!parsed || parsed->action != qtet::CommandLine::Action::kServe) return 0;
  const std::string text = qtet::configText(*parsed);
  std::vector<std::string> again{"qtet-server"};
  std::istringstream settings(text);
  for (std::string line; std::getline(settings, line);) {
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) return 0;  // a value with a line end
    again.push_back("--" + line.substr(0, equals) + "=" + line.substr(equals + 3));
  }
  std::vector<const char*> second;
  for (const std::string& a : again) second.push_back(a.c_str());
  const auto same = qtet::parseCommandLine(static_cast<int>(second.size()), second.data(), nullptr);
  if (same && qtet::configText(*same) != text) std::abort();
  return 0;
}

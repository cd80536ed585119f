#include <algorithm>
#include <sstream>

#include "proto/version.h"
#include "simplify/commands/command_help.h"
#include "simplify/words/json_report.h"
#include "simplify/words/output.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// Text for man(7): hyphens that can be copied, no line that begins like a request.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool atLineStart = i == 0 || text[i - 1] == '\n';
    if (atLineStart && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\') {
      out += "\\e";
    } else {
      out += text[i] == '-' ? "\\-" : std::string(1, text[i]);
    }
  }
  return out;
}

std::string head(const std::string& page, const std::string& summary) {
  std::string upper = page;
  std::ranges::transform(upper, upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return ".TH " + upper + " 1 \"\" \"qtet " + version() + "\" \"User Commands\"\n.SH NAME\n" +
         roff(page + " - " + summary) + "\n";
}

std::string verbatim(const std::string& text) {
  return ".nf\n" + roff(text) + (text.ends_with('\n') ? "" : "\n") + ".fi\n";
}

constexpr const char* kExits =
    ".SH EXIT STATUS\n0 done, 1 an input or a file is at fault, 2 the command line is.\n";

std::string entryOf(const OrderedJson& option) {
  const auto letter = option["letter"].get<std::string>();
  std::string out = ".TP\n.B " + roff((letter.empty() ? "" : "-" + letter + ", ") + "--" +
                                      option["name"].get<std::string>());
  if (option["takesValue"]) out += roff(" " + option["parameter"].get<std::string>());
  return out + "\n" + roff(option["text"]) + "\n";
}

std::string commandPage(const Command& command) {
  const OrderedJson help = helpOf(command);
  std::string out = head("qtet-" + std::string(command.name), std::string(command.summary)) +
                    ".SH SYNOPSIS\n.B qtet\n" + roff(help["usage"]) + "\n.SH DESCRIPTION\n" +
                    roff(help["text"]) + "\n.SH OPTIONS\n";
  std::vector<std::string> groups{""};
  for (const OrderedJson& option : help["options"]) {
    const auto group = option["group"].get<std::string>();
    if (std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
  }
  for (const std::string& group : groups) {
    if (!group.empty()) out += ".SS " + roff(group) + "\n";
    for (const OrderedJson& option : help["options"])
      if (option["group"] == group) out += entryOf(option);
  }
  return out + ".SH EXAMPLES\n" + verbatim(help["examples"]) + kExits +
         ".SH SEE ALSO\n.BR qtet (1)\n";
}

/// `text` is what `qtet --help` prints.
std::string overviewPage(const std::string& text) {
  std::string out = head("qtet", "tetrahedral meshes that a browser shows coarse-first") +
                    ".SH DESCRIPTION\n" + verbatim(text) + ".SH SEE ALSO\n";
  for (const Command& command : commands())
    out += ".BR qtet\\-" + roff(std::string(command.name)) + " (1),\n";
  return out + ".BR qtet\\-server (1)\n";
}

CommandHelp manualHelp() {
  return {"manual", "manual FOLDER",
          R"(Writes qtet.1 and a page for every command, qtet-COMMAND.1, into an existing folder.
They say what --help says.)",
          "  mkdir -p ~/.local/share/man/man1 && qtet manual ~/.local/share/man/man1 && "
          "man qtet-simplify\n"};
}

}  // namespace

int runManual(const Words& words, Console& console) {
  po::options_description options("options");
  addNoClobber(options);
  const ParsedWords parsed(words, manualHelp(), options, {"FOLDER"});
  if (parsed.helped(console)) return kExitOk;
  const fs::path folder = parsed.get<std::string>("FOLDER");
  std::ostringstream overview, err;
  Console inside{overview, err};
  runTool({"--help"}, inside);
  std::vector<std::pair<std::string, std::string>> pages{{"qtet.1", overviewPage(overview.str())}};
  for (const Command& command : commands())
    pages.emplace_back("qtet-" + std::string(command.name) + ".1", commandPage(command));
  for (const auto& [name, text] : pages) {
    const Output page{folder / name, parsed.has("no-clobber")};
    if (Status checked = checkOutput(page, ".1"); !checked)
      return reportFailure(checked.error(), false, console);
    if (Status written = writeOutput(page, Bytes(text.begin(), text.end())); !written)
      return reportFailure(written.error(), false, console);
  }
  console.out << folder.string() << ": " << pages.size() << " pages\n";
  return kExitOk;
}

}  // namespace qtet

#include "simplify/commands/command_help.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

/// A text between single quotes, for all three shells; fish knows \' inside, the others do not.
std::string quoted(const std::string& text, bool fish) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += fish ? "\\'" : "'\\''";
    } else {
      out += c == '\n' ? ' ' : c;
    }
  }
  return out + "'";
}

std::string bashScript() {
  std::string names, cases;
  for (const Command& command : commands()) {
    names += std::string(names.empty() ? "" : " ") + std::string(command.name);
    cases += "    " + std::string(command.name) + ") words=\"";
    const OrderedJson help = helpOf(command);
    for (const OrderedJson& option : help["options"])
      cases += "--" + option["name"].get<std::string>() + " ";
    cases.back() = '"';
    cases += " ;;\n";
  }
  return "# qtet's words for bash: source <(qtet completion bash)\n_qtet() {\n  local "
         "cur=${COMP_WORDS[COMP_CWORD]} words=\n  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n    mapfile -t COMPREPLY < <(compgen -W \"" +
         names +
         " help --help --version\" -- \"$cur\")\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n" +
         cases +
         "  esac\n  if [[ $cur == -* ]]; then\n    mapfile -t COMPREPLY < <(compgen -W \"$words\" "
         "-- \"$cur\")\n"
         "  elif [[ ${COMP_WORDS[1]} == completion ]]; then\n    mapfile -t COMPREPLY < <(compgen "
         "-W \"bash zsh fish\" -- \"$cur\")\n"
         "  elif [[ ${COMP_WORDS[1]} == help ]]; then\n    mapfile -t COMPREPLY < <(compgen -W \"" +
         names +
         "\" -- \"$cur\")\n"
         "  else\n    compopt -o filenames 2>/dev/null\n    mapfile -t COMPREPLY < <(compgen -f -- "
         "\"$cur\")\n  fi\n}\ncomplete -F _qtet qtet\n";
}

/// _arguments gives brackets and colons a meaning.
std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : firstClause(text))
    out += std::string(c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + c;
  return out;
}

std::string zshScript() {
  std::string list, cases;
  for (const Command& command : commands()) {
    const std::string name(command.name);
    list += "    " + quoted(name + ":" + std::string(command.summary), false) + "\n";
    cases += "  " + name + ")\n    _arguments";
    const OrderedJson help = helpOf(command);
    for (const OrderedJson& option : help["options"]) {
      const std::string value = option["takesValue"] ? ":value:_files" : "";
      cases += " \\\n      " + quoted("--" + option["name"].get<std::string>() + "[" +
                                          zshText(option["text"]) + "]" + value,
                                      false);
    }
    cases += name == "completion" ? " \\\n      '*:shell:(bash zsh fish)'\n    ;;\n"
                                  : " \\\n      '*:file:_files'\n    ;;\n";
  }
  return "#compdef qtet\n# qtet's words for zsh: qtet completion zsh > a folder of $fpath, as "
         "_qtet\nlocal -a qtet_commands\nqtet_commands=(\n" +
         list +
         ")\nif ((CURRENT == 2)); then\n  _describe command qtet_commands\n  return\nfi\nlocal "
         "command=$words[2]\nshift words\n((CURRENT--))\ncase $command in\n" +
         cases + "esac\n";
}

std::string fishScript() {
  std::string out =
      "# qtet's words for fish: qtet completion fish > ~/.config/fish/completions/qtet.fish\n";
  for (const Command& command : commands()) {
    const std::string name(command.name),
        here = "complete -c qtet -n '__fish_seen_subcommand_from " + name + "'";
    out += "complete -c qtet -n __fish_use_subcommand -f -a " + name + " -d " +
           quoted(std::string(command.summary), true) + "\n";
    const OrderedJson help = helpOf(command);
    for (const OrderedJson& option : help["options"]) {
      const auto letter = option["letter"].get<std::string>();
      out += here + " -l " + option["name"].get<std::string>() +
             (letter.empty() ? "" : " -s " + letter) + (option["takesValue"] ? " -r" : "") +
             " -d " + quoted(firstClause(option["text"]), true) + "\n";
    }
    if (name == "completion") out += here + " -f -a 'bash zsh fish'\n";
  }
  return out;
}

CommandHelp completionHelp() {
  return {"completion", "completion bash|zsh|fish",
          R"(Prints what makes a shell complete qtet's commands and options.
The Debian package brings it along.)",
          R"(  source <(qtet completion bash)
  qtet completion zsh > ~/.zfunc/_qtet
  qtet completion fish > ~/.config/fish/completions/qtet.fish
)"};
}

}  // namespace

int runCompletion(const Words& words, Console& console) {
  const ParsedWords parsed(words, completionHelp(), po::options_description("options"), {"SHELL"});
  if (parsed.helped(console)) return kExitOk;
  const auto shell = parsed.get<std::string>("SHELL");
  if (shell != "bash" && shell != "zsh" && shell != "fish")
    throw UsageError("the shell '" + shell + "' is not known; give bash, zsh or fish");
  console.out << (shell == "bash" ? bashScript() : shell == "zsh" ? zshScript() : fishScript());
  return kExitOk;
}

}  // namespace qtet

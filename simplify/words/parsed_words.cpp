#include "simplify/words/parsed_words.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

#include "proto/option_error.h"
#include "simplify/words/did_you_mean.h"
#include "simplify/words/json_report.h"
#include "simplify/words/printable.h"

namespace qtet {

namespace {

/// Words without a dash that no place is left for. Boost's own error does not say which they are.
constexpr const char* kTooMany = "one too many";

/// "LOG..." stands for one word and more.
bool takesMore(const std::string& name) { return name.ends_with("..."); }

/// The error for the first word of `more`: it says what is wrong, and where the word was most
/// probably meant to go.
UsageError oneTooMany(const CommandHelp& help, const std::vector<std::string>& positional,
                      const std::vector<std::string>& more, bool wantsOutput) {
  std::string places;
  for (const std::string& name : positional) places += (places.empty() ? "" : " and ") + name;
  const std::string word = "'" + more.front() + "'";
  return UsageError(word + " is one word too many, 'qtet " + help.name + "' takes " + places +
                    (wantsOutput ? "; name the output with -o " + more.front() : ""));
}

}  // namespace

ParsedWords::ParsedWords(const Words& words, CommandHelp help, po::options_description options,
                         const std::vector<std::string>& positional)
    : help_(std::move(help)), positional_(positional) {
  // runTool takes these away before; they are named here for help.
  options.add_options()("quiet,q", "print nothing but errors, warnings and what was asked for")(
      "verbose,v", "report how long each stage takes, and the memory at most")(
      "help,h", "show this and stop");
  if (!help_.rareOptions.empty()) options.add_options()("help-all", "show every option and stop");
  options_.add(options);

  po::options_description all, hidden;
  po::positional_options_description places;
  for (const std::string& name : positional_) {
    if (takesMore(name)) {
      hidden.add_options()(name.c_str(), po::value<std::vector<std::string>>());
      places.add(name.c_str(), -1);
    } else {
      hidden.add_options()(name.c_str(), po::value<std::string>());
      places.add(name.c_str(), 1);
    }
  }
  if (positional_.empty() || !takesMore(positional_.back())) places.add(kTooMany, -1);
  hidden.add_options()("help-json", "help for programs")(kTooMany,
                                                         po::value<std::vector<std::string>>());
  if (help_.rareOptions.empty()) hidden.add_options()("help-all", "the same as --help");
  all.add(options_).add(hidden);
  try {
    const auto style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(words).options(all).positional(places).style(style).run(),
              values_);
    po::notify(values_);
  } catch (po::unknown_option& error) {
    const std::string near = nearOption(error.get_option_name());
    throw UsageError(optionErrorText<po::error_with_option_name>(error) + near);
  } catch (po::error& error) {
    throw UsageError(optionErrorText<po::error_with_option_name>(error));
  }
  if (has("help") || has("help-all") || has("help-json")) return;
  if (has(kTooMany))
    throw oneTooMany(help_, positional_, get<std::vector<std::string>>(kTooMany),
                     isRequired("output") && !has("output"));
  for (const std::string& name : positional_) {
    if (!has(name))
      throw UsageError((takesMore(name) ? name.substr(0, name.size() - 3) : name) + " is missing");
  }
  refuseOutputWord();
  for (const auto& option : options_.options()) {
    const std::string& name = option->long_name();
    if (isRequired(name) && !has(name)) throw UsageError("--" + name + " is missing");
  }
}

void ParsedWords::refuseOutputWord() const {
  if (positional_.empty() || !takesMore(positional_.back()) || !isRequired("output") ||
      has("output"))
    return;
  const auto words = get<std::vector<std::string>>(positional_.back());
  std::error_code code;
  if (words.size() > 1 && !std::filesystem::exists(words.back(), code))
    throw oneTooMany(help_, positional_, {words.back()}, true);
}

std::string ParsedWords::nearOption(const std::string& unknown) const {
  const std::size_t name = unknown.find_first_not_of('-');
  if (name < 2 || name == std::string::npos) return "";  // a letter is near to every other one
  std::vector<std::string> known;
  for (const auto& option : options_.options()) known.push_back(option->long_name());
  return didYouMean(std::string_view(unknown).substr(name), known, "--");
}

bool ParsedWords::isRequired(const std::string& option) const {
  const auto* found = options_.find_nothrow(option, false);
  return found != nullptr && found->description().starts_with("required: ");
}

std::string ParsedWords::titleOf(const std::string& option) const {
  for (const OptionGroup& group : help_.rareOptions)
    if (std::ranges::find(group.options, option) != group.options.end()) return group.title;
  return "";
}

std::string ParsedWords::optionText(bool all) const {
  std::ostringstream out;
  const auto add = [&](const std::string& title) {
    po::options_description shown(title.empty() ? "options" : title);
    for (const auto& option : options_.options())
      if (titleOf(option->long_name()) == title) shown.add(option);
    out << shown << "\n";
  };
  add("");
  if (help_.rareOptions.empty()) return out.str();
  std::size_t rare = 0;
  for (const OptionGroup& group : help_.rareOptions) {
    rare += group.options.size();
    if (all) add(group.title);
  }
  if (!all)
    out << "'qtet " << help_.name << " --help-all' shows " << rare
        << " more, for special inputs, sizes and qualities.\n\n";
  return out.str();
}

bool ParsedWords::helped(Console& console) const {
  if (has("help-json")) {
    OrderedJson options = OrderedJson::array();
    for (const auto& option : options_.options()) {
      const std::string brief = option->format_name();  // "-o [ --output ]" or "--output"
      options.push_back({{"name", option->long_name()},
                         {"letter", brief.size() > 1 && brief[1] != '-' ? brief.substr(1, 1) : ""},
                         {"takesValue", option->semantic()->max_tokens() > 0},
                         {"parameter", option->format_parameter()},
                         {"group", titleOf(option->long_name())},
                         {"text", option->description()}});
    }
    printJson({{"name", help_.name},
               {"usage", help_.usage},
               {"text", help_.text},
               {"examples", help_.examples},
               {"words", positional_},
               {"options", options}},
              console);
    return true;
  }
  if (!has("help") && !has("help-all")) return false;
  console.out << filled("usage: qtet " + help_.usage, "       ") << "\n\n"
              << filled(help_.text) << "\n\n"
              << optionText(has("help-all")) << "examples:\n"
              << help_.examples;
  return true;
}

double ParsedWords::number(const std::string& name, double low, double high) const {
  const auto value = get<double>(name);
  if (value >= low && value <= high) return value;
  std::ostringstream text;
  text << "--" << name << " " << value << " is outside " << low << " to " << high;
  throw UsageError(text.str());
}

int ParsedWords::integer(const std::string& name, int low, int high) const {
  const auto value = get<int>(name);
  if (value >= low && value <= high) return value;
  throw UsageError("--" + name + " " + std::to_string(value) + " is outside " +
                   std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace qtet

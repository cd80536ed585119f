// One command's options and help, and its words parsed by them.
#pragma once

#include <boost/program_options.hpp>
#include <cassert>
#include <string>
#include <vector>

#include "simplify/words/console.h"
#include "simplify/words/usage_error.h"

namespace qtet {

namespace po = boost::program_options;

/// Options under one heading.
struct OptionGroup {
  std::string title;
  std::vector<std::string> options;  ///< long names
};

/// One command's help: usage line, what it does, options, examples.
struct CommandHelp {
  std::string name;
  std::string usage;  ///< "simplify IN -o OUT.qtet [options]"
  std::string text;
  std::string examples;  ///< one a line
  /// Where a command has many options: --help shows those that are in no group, --help-all all.
  std::vector<OptionGroup> rareOptions{};
};

/// One command's words, parsed. Options may be given once, abbreviations are refused.
class ParsedWords {
 public:
  /// `positional` are the names of the words without a dash, all required; the last may end in
  /// "...", which is a vector of one word and more.
  ParsedWords(const Words& words, CommandHelp help, po::options_description options,
              const std::vector<std::string>& positional);

  /// Whether --help, --help-all or, for the manual and completions, --help-json was asked for. It
  /// is printed then.
  [[nodiscard]] bool helped(Console& console) const;
  [[nodiscard]] bool has(const std::string& name) const { return values_.count(name) > 0; }
  template <class T>
  [[nodiscard]] T get(const std::string& name) const {
    assert(has(name));
    return values_[name].as<T>();
  }
  /// A number of `low` to `high`. Throws UsageError.
  [[nodiscard]] double number(const std::string& name, double low, double high) const;
  [[nodiscard]] int integer(const std::string& name, int low, int high) const;

 private:
  [[nodiscard]] bool isRequired(const std::string& option) const;
  /// Throws UsageError where the output lacks its -o, as the last of several words.
  void refuseOutputWord() const;
  /// didYouMean of an option as it was given, "--colour".
  [[nodiscard]] std::string nearOption(const std::string& unknown) const;
  /// The heading of a rare option, "" of any other.
  [[nodiscard]] std::string titleOf(const std::string& option) const;
  [[nodiscard]] std::string optionText(bool all) const;

  CommandHelp help_;
  po::options_description options_;
  std::vector<std::string> positional_;
  po::variables_map values_;
};

}  // namespace qtet

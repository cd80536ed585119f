// Shared by the tool's commands: parsing their words, refusing them with a hint, reporting
// failures, checking outputs early.
#pragma once

#include <boost/program_options.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "codec/files/mesh_file.h"
#include "proto/error.h"
#include "simplify/commands/commands.h"

namespace qtet {

/// Members keep the order in which they are set, which is the order in which people read them.
using OrderedJson = nlohmann::ordered_json;

/// Words that are not understood; the message, one line, says which and what would be. The tool
/// adds a line that leads to the command's help.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

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
  ParsedWords(const Words& words, CommandHelp help,
              boost::program_options::options_description options,
              const std::vector<std::string>& positional);

  /// Whether --help, --help-all or, for the manual and completions, --help-json was asked for. It
  /// is printed then.
  [[nodiscard]] bool helped(Console& console) const;
  [[nodiscard]] bool has(const std::string& name) const { return values_.count(name) > 0; }
  template <class T>
  [[nodiscard]] T get(const std::string& name) const {
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
  boost::program_options::options_description options_;
  std::vector<std::string> positional_;
  boost::program_options::variables_map values_;
};

/// The help of every option --fields of a mesh or a log (proto/field_key.h).
inline constexpr const char* kFieldsHelp =
    "all, none, or names between commas: NAME means every field of that name, of a series (--time "
    "all) every step's, NAME@TIME; point:NAME or cell:NAME is one of two with the same name; \\, "
    "is a comma in a name";

/// The names between commas, of which "\\," is one in a name, and "\\\\" a backslash before it;
/// "all" is nullopt, "none" the empty list. Throws UsageError.
[[nodiscard]] std::optional<std::vector<std::string>> parseFieldNames(const std::string& text);

/// A mesh file to write: its kind, and its name or the standard output ("-" with --to).
struct MeshOutput {
  std::filesystem::path file;
  std::string ending;  ///< with its dot
  bool isStandardOutput = false;
  bool asJson = false;    ///< reports it as one JSON object
  bool keepsOld = false;  ///< --no-clobber
  MeshFileOptions options{};
};

/// -o, --to, --no-draco, --no-clobber and --json for meshOutputOf.
void addMeshOutputOptions(boost::program_options::options_description& options);

/// The report about a mesh that was written.
struct MeshOutputReport {
  std::string sentence;
  OrderedJson json;  ///< the members beside `output`, `kind` and `bytes`
};

/// The output that -o and --to name, checked as checkOutput does; `endings` are those that it may
/// have. Throws UsageError, also where --json and the file both want the standard output.
[[nodiscard]] Result<MeshOutput> meshOutputOf(const ParsedWords& parsed, const std::string& input,
                                              const std::string& endings = kWrittenEndings);

/// Writes the file whole or not at all, and reports it on the standard output: the sentence, or
/// with --json one object. Where the file is the standard output the sentence is a note.
[[nodiscard]] Status writeMeshOutput(const MeshOutput& output, std::span<const std::uint8_t> bytes,
                                     const MeshOutputReport& report, Console& console);
/// The report alone, about a file of so many bytes that is written.
void reportMeshOutput(const MeshOutput& output, std::uint64_t bytes, const MeshOutputReport& report,
                      Console& console);

/// [{name, association, components, type}] of the fields that a file of this kind holds; `Field` is
/// MeshField or ManifestField.
template <class Fields>
[[nodiscard]] OrderedJson writtenFieldsJson(const Fields& fields, const std::string& ending) {
  OrderedJson out = OrderedJson::array();
  for (const auto& field : fields)
    if (holdsFields(ending, field.association))
      out.push_back({{"name", field.name},
                     {"association", field.association},
                     {"components", field.components},
                     {"type", field.type}});
  return out;
}

/// Prints the failure, also as {"error":{"code","message"}} on `out` where JSON was asked for;
/// returns kExitFailed.
int reportFailure(const Error& error, bool asJson, Console& console);

/// Prints one JSON object; bytes that are no UTF-8 are replaced.
void printJson(const OrderedJson& json, Console& console);

}  // namespace qtet

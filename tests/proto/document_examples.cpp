#include "tests/proto/document_examples.h"

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "proto/messages.h"
#include "tests/proto/openapi_schema.h"

namespace qtet::test {
namespace {

using Json = nlohmann::json;

/// Whether all that an example says stands in what was written of it. null is as good as absent.
bool isWithin(const Json& example, const Json& written) {
  if (!example.is_object()) return example == written;
  if (!written.is_object()) return false;
  return std::ranges::all_of(example.items(), [&](const auto& item) {
    if (item.value().is_null())
      return !written.contains(item.key()) || written[item.key()].is_null();
    return written.contains(item.key()) && isWithin(item.value(), written[item.key()]);
  });
}

/// Empty, or why the parser does not take the whole message.
template <class Parse>
std::string judgeMessage(const std::string& text, const Parse& parse) {
  const auto message = parse(text);
  if (!message) return message.error().message;
  Json example = Json::parse(text);
  if (example["type"] == "stop") example["type"] = "cancel";  // its older name
  const std::string written = toJson(*message);
  return isWithin(example, Json::parse(written)) ? "" : "it was understood as " + written;
}

std::string judgeClient(const std::string& text) { return judgeMessage(text, parseClientMessage); }
std::string judgeServer(const std::string& text) { return judgeMessage(text, parseServerMessage); }

std::string judgeHave(const std::string& text) {
  return judgeClient(R"({"type":"resume","have":)" + text + "}");
}
std::string judgeTarget(const std::string& text) {
  return judgeClient(R"({"type":"target","target":)" + text + "}");
}

std::string judgeTime(const std::string& text) {
  return judgeClient(R"({"type":"open","mesh":"a","credit":1,"time":)" + text + "}");
}

const OpenapiSchemas& schemas() {
  static const OpenapiSchemas kSchemas;
  return kSchemas;
}
std::string judgeList(const std::string& text) {
  return schemas().complaint("MeshList", Json::parse(text), {"links"});
}
std::string judgeMesh(const std::string& text) {
  return schemas().complaint("Mesh", Json::parse(text), {"links", "manifest"});
}
std::string judgeSeries(const std::string& text) {
  return schemas().complaint("Series", Json::parse(text));
}
std::string judgeManifest(const std::string& text) {
  return schemas().complaint("Manifest", Json::parse(text));
}

/// A line of a session with those that continue it.
std::string judgeTurn(const std::string& text) {
  static const std::regex kFrame(R"(< frame \d+ \d+ (head|\d+\+\d+) \d+)");
  if (text.starts_with("# ") || std::regex_match(text, kFrame)) return "";
  if (text.starts_with("> {")) return judgeClient(text.substr(2));
  if (text.starts_with("< {")) return judgeServer(text.substr(2));
  return "it is no message, frame or remark";
}

const std::map<std::string, std::function<std::string(const std::string&)>> kJudges{
    {"json client", judgeClient},  {"json server", judgeServer},     {"json have", judgeHave},
    {"json target", judgeTarget},  {"json time", judgeTime},         {"json list", judgeList},
    {"json mesh", judgeMesh},      {"json manifest", judgeManifest}, {"json series", judgeSeries},
    {"text transcript", judgeTurn}};

/// A value or a turn, and the line that it begins in.
struct Example {
  std::size_t line;
  std::string text;
};

class Examiner {
 public:
  void read(const std::string& document) {
    std::istringstream lines(document);
    for (std::string line; std::getline(lines, line);) take(line, ++line_);
    if (isOpen_) blame(line_, "the last block is not closed");
    for (const auto& [kind, judge] : kJudges)
      if (!seen_.contains(kind)) blame(line_, "no example is '" + kind + "'");
  }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  void take(const std::string& line, std::size_t number) {
    if (line.starts_with("```"))
      isOpen_ ? endBlock() : beginBlock(line.substr(3), number);
    else if (isOpen_ && line.starts_with(' ') && !examples_.empty())
      examples_.back().text += "\n" + line;
    else if (isOpen_)
      examples_.push_back({number, line});
  }

  void beginBlock(const std::string& kind, std::size_t number) {
    isOpen_ = true;
    kind_ = kind;
    if (kind != "text" && !kJudges.contains(kind))
      blame(number, "what is a block of '" + kind + "'?");
  }

  void endBlock() {
    isOpen_ = false;
    for (const Example& example : examples_) judge(example);
    examples_.clear();
  }

  void judge(const Example& example) {
    const auto judge = kJudges.find(kind_);
    if (judge == kJudges.end()) {
      if (example.text.find('{') != std::string::npos)
        blame(example.line, "JSON in a block of '" + kind_ + "' is judged by nobody");
      return;
    }
    seen_.insert(kind_);
    std::string why;
    try {
      why = judge->second(example.text);
    } catch (const Json::exception& e) {
      why = e.what();
    }
    if (!why.empty()) blame(example.line, kind_ + ": " + why);
  }

  void blame(std::size_t line, const std::string& what) {
    faults_.push_back("line " + std::to_string(line) + ": " + what);
  }

  std::size_t line_ = 0;
  bool isOpen_ = false;
  std::string kind_;  // of the open block
  std::vector<Example> examples_;
  std::set<std::string> seen_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> faultsOfExamples(const std::string& document) {
  Examiner examiner;
  examiner.read(document);
  return examiner.faults();
}

}  // namespace qtet::test

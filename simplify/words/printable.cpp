#include "simplify/words/printable.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "proto/utf8.h"

namespace qtet {
namespace {

/// How many bytes of a control character `text` begins with.
std::size_t controlBytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return 1;
  return byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) < 0xA0 ? 2 : 0;
}

}  // namespace

std::string printable(std::string_view given, bool keepLines) {
  const std::string sound = soundUtf8(given);
  std::string_view text = sound;
  std::string out;
  while (!text.empty()) {
    std::size_t control = controlBytes(text);
    if (keepLines && text[0] == '\n') control = 0;
    out += control > 0 ? std::string_view("\uFFFD") : text.substr(0, 1);
    text.remove_prefix(control > 0 ? control : 1);
  }
  return out;
}

std::size_t textWidth(std::string_view text) {
  const auto beginsCharacter = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  };
  return static_cast<std::size_t>(std::ranges::count_if(text, beginsCharacter));
}

namespace {

/// Where the text of an item begins, "  name  text"; 0: the line is none.
std::size_t hangOf(std::string_view line) {
  if (!line.starts_with("  ")) return 0;
  const std::size_t name = line.find_first_not_of(' '), gap = line.find("  ", name);
  const std::size_t text = line.find_first_not_of(' ', gap);
  return text == std::string_view::npos ? 0 : text;
}

}  // namespace

std::string filled(std::string_view text, std::string_view indent) {
  std::string out, within;
  std::size_t column = 0;
  const auto newLine = [&](std::string_view begin) {
    out += '\n';
    out += begin;
    column = textWidth(begin);
  };
  std::istringstream lines{std::string(text)};
  bool inParagraph = false;
  for (std::string line, word; std::getline(lines, line);) {
    if (line.empty()) {
      if (std::exchange(inParagraph, false)) out += '\n';
      continue;
    }
    const std::size_t hang = hangOf(line);
    const bool begins = !std::exchange(inParagraph, true) || line.starts_with('-') || hang > 0;
    if (begins && !out.empty()) newLine("");
    if (begins) within = hang > 0 ? std::string(hang, ' ') : std::string(indent);
    out += line.substr(0, hang);
    column += hang;
    line.erase(0, hang);
    bool first = begins;
    for (std::istringstream words(line); words >> word; first = false) {
      if (!first && column + 1 + textWidth(word) > kHelpColumns) {
        newLine(within);
      } else if (!first) {
        out += ' ', ++column;
      }
      out += word;
      column += textWidth(word);
    }
  }
  return out;
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, 1, ',');
  return text;
}

std::string counted(std::uint64_t number, std::string_view one, std::string_view many) {
  return grouped(number) + " " + std::string(number == 1 ? one : many);
}

}  // namespace qtet

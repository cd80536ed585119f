// Writes EnSight's files in each of their encodings.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace qtet::testing {

enum class EnSightKind : std::uint8_t { kText, kLittle, kBig, kFortranLittle, kFortranBig };
inline constexpr std::array kEnSightKinds{EnSightKind::kText, EnSightKind::kLittle,
                                          EnSightKind::kBig, EnSightKind::kFortranLittle,
                                          EnSightKind::kFortranBig};

class EnSightWriter {
 public:
  EnSightWriter(EnSightKind kind, bool isGold) : kind_(kind), isGold_(isGold) {}

  /// The first line of a binary geometry.
  EnSightWriter& header() {
    if (isText()) return *this;
    return line(isFortran() ? "Fortran Binary" : "C Binary");
  }
  EnSightWriter& line(std::string_view text) {
    if (isText()) {
      bytes_ += std::string(text) + "\n";
    } else {
      std::string out(text);
      out.resize(80, isFortran() ? ' ' : '\0');
      record(out);
    }
    return *this;
  }
  EnSightWriter& integers(const std::vector<std::int32_t>& values, std::size_t inALine = 1) {
    std::string out;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (isText()) {
        std::array<char, 16> text{};
        std::snprintf(text.data(), text.size(), isGold_ ? "%10d" : "%8d", values[i]);
        out += text.data();
        if ((i + 1) % inALine == 0 || i + 1 == values.size()) out += "\n";
      } else {
        put(static_cast<std::uint32_t>(values[i]), out);
      }
    }
    record(out);
    return *this;
  }
  /// As text one in a line in Gold, six in EnSight 6.
  EnSightWriter& reals(const std::vector<float>& values, std::size_t inALine = 0) {
    if (inALine == 0) inALine = isGold_ ? 1 : 6;
    std::string out;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (isText()) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%12.5e", static_cast<double>(values[i]));
        out += text.data();
        if ((i + 1) % inALine == 0 || i + 1 == values.size()) out += "\n";
      } else {
        put(std::bit_cast<std::uint32_t>(values[i]), out);
      }
    }
    record(out);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] bool isText() const { return kind_ == EnSightKind::kText; }

 private:
  [[nodiscard]] bool isFortran() const {
    return kind_ == EnSightKind::kFortranLittle || kind_ == EnSightKind::kFortranBig;
  }
  void put(std::uint32_t value, std::string& out) const {
    const bool isBig = kind_ == EnSightKind::kBig || kind_ == EnSightKind::kFortranBig;
    const std::uint32_t stored =
        isBig == (std::endian::native == std::endian::big) ? value : std::byteswap(value);
    const auto raw = std::bit_cast<std::array<char, 4>>(stored);
    out.append(raw.data(), raw.size());
  }
  void record(const std::string& content) {
    if (content.empty()) return;
    std::string mark;
    if (isFortran()) put(static_cast<std::uint32_t>(content.size()), mark);
    bytes_ += mark + content + mark;
  }

  EnSightKind kind_;
  bool isGold_;
  std::string bytes_;
};

inline void writeBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace qtet::testing

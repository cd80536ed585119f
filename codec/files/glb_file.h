// The frame of a binary glTF 2.0 file: one mesh of one primitive. For .cpp files only, because it
// includes nlohmann-json.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proto/bytes.h"

namespace qtet {

// glTF 2.0, 3.6.2.2
inline constexpr int kGlbUnsignedByte = 5121;
inline constexpr int kGlbUnsignedInt = 5125;
inline constexpr int kGlbFloat = 5126;

/// A file holds fewer bytes than this: its lengths have 32 bits.
inline constexpr std::uint64_t kMaxGlbBytes = std::uint64_t{1} << 32;

/// "SCALAR", "VEC2", "VEC3" or "VEC4"; nullptr for other numbers of components, which glTF does not
/// have.
[[nodiscard]] const char* glbType(std::size_t components);

/// The file's content without its frame, in glTF's terms. Accessor 0 is the indices.
struct GlbContent {
  nlohmann::ordered_json accessors, bufferViews;
  nlohmann::ordered_json attributes;    ///< of the primitive
  nlohmann::ordered_json extensions{};  ///< of the primitive; null without any
  std::vector<std::string> requiredExtensions{};
  std::array<double, 3> translation{};  ///< of the node: what is added to every position
};

/// The file: two-sided, not shiny, one buffer. REQUIRES: fewer than kMaxGlbBytes with the frame.
[[nodiscard]] Bytes glbBytes(const GlbContent& content, ByteView buffer);

}  // namespace qtet

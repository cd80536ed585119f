// A text file that is being read line by line, perhaps while another one that it includes is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace qtet {

struct OpenText {
  std::filesystem::path path;
  std::string text;
  std::size_t place = 0;
  std::uint64_t line = 0;  ///< from 1; 0 before the first one
};

}  // namespace qtet

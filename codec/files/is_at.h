// Whether a file that is open has its name still.
#pragma once

#include <sys/stat.h>

#include <filesystem>

namespace qtet {

/// Whether `path` names the file or folder that is open: between our opening and our locking it
/// somebody else may have renamed or removed it.
[[nodiscard]] inline bool isAt(const std::filesystem::path& path, int descriptor) {
  struct stat opened{}, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace qtet

#include "codec/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <string>

namespace qtet {

TemporaryFolder::TemporaryFolder(std::string_view purpose) {
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failure_);
  if (failure_) return;
  std::string name = (parent / ("qtet-" + std::string(purpose) + "-XXXXXX")).string();
  if (::mkdtemp(name.data()) != nullptr)
    path_ = name;
  else
    failure_.assign(errno, std::generic_category());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace qtet

// What is served: the logs of one folder, opened and checked once at the start, immutable from then on.
#pragma once

#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "codec/log_file.h"
#include "proto/manifest.h"

namespace qtet {

/// A log under its name, with its manifest read.
struct ServedMesh {
  std::string id;  ///< the file's name without `.qtet`
  LogFile log;
  Manifest manifest;     ///< agrees with the log's table: as many fields, as many components, chunks that exist
  std::time_t modified;  ///< the file's, in seconds since 1970

  /// Length of the file's prefix that holds level `level`. REQUIRES: such a level.
  [[nodiscard]] std::uint64_t prefixBytes(std::uint32_t level) const;
};

/// Opens a log and checks everything that can be checked without decoding: header, table, manifest, every CRC-32C.
[[nodiscard]] Result<ServedMesh> openMesh(const std::filesystem::path& path);

/// Safe to read from any thread. Pointers and views stay valid as long as the store.
class MeshStore {
 public:
  /// A file that is not served, and why.
  struct Refused {
    std::filesystem::path path;
    Error error;
  };

  /// Opens every `*.qtet` of `folder` (not below it). Damaged ones end up in `refused`. Errors: io (the folder cannot be read).
  [[nodiscard]] static Result<MeshStore> open(const std::filesystem::path& folder);

  /// nullptr when there is none of that name.
  [[nodiscard]] const ServedMesh* find(std::string_view id) const;
  /// In the order of ids.
  [[nodiscard]] const std::map<std::string, ServedMesh, std::less<>>& meshes() const { return meshes_; }
  [[nodiscard]] const std::vector<Refused>& refused() const { return refused_; }

 private:
  std::map<std::string, ServedMesh, std::less<>> meshes_;
  std::vector<Refused> refused_;
};

}  // namespace qtet

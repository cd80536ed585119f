// What is served: the logs of one folder, opened and checked, as immutable snapshots that follow
// the folder (folder_watch.h).
#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/served_mesh.h"

namespace qtet {

/// What is served at one moment.
struct Catalogue {
  /// A file that is not served, and why.
  struct Refused {
    std::filesystem::path path;
    FileIdentity file;
    Error error;
  };
  using Meshes = std::map<std::string, MeshPointer, std::less<>>;

  Meshes meshes;  ///< by id
  Meshes logs;    ///< by digest, with those that were replaced a short while ago
  std::vector<Refused> refused;
  std::string etag;         ///< changes with the ids and their logs; without quotes
  std::time_t changed = 0;  ///< seconds since 1970
};
using CataloguePointer = std::shared_ptr<const Catalogue>;

/// What `rescan` found.
struct FolderChange {
  std::vector<MeshPointer> added;  ///< new or replaced
  std::vector<std::string> removed;
  std::vector<Catalogue::Refused> refused;  ///< newly
  [[nodiscard]] bool any() const { return !added.empty() || !removed.empty(); }
};

/// Thread-safe but for moves.
class MeshStore {
 public:
  /// No folder and no meshes.
  MeshStore();
  MeshStore(MeshStore&&) noexcept;
  MeshStore& operator=(MeshStore&&) noexcept;
  ~MeshStore();

  /// Opens every `*.qtet` of `folder` (not below it, and no link that leads out of it). Damaged
  /// ones end up in `refused`. Errors: io (the folder cannot be read).
  [[nodiscard]] static Result<MeshStore> open(const std::filesystem::path& folder);

  /// Looks at the folder again; opens what is new or has changed. A damaged file that took the
  /// place of a sound one leaves the sound one served. Errors: io (the folder cannot be read;
  /// everything stays as it was).
  [[nodiscard]] Result<FolderChange> rescan() const;

  [[nodiscard]] const std::filesystem::path& folder() const;
  [[nodiscard]] CataloguePointer catalogue() const;
  /// nullptr when there is none of that name.
  [[nodiscard]] MeshPointer find(std::string_view id) const;
  /// nullptr when there is none of that digest.
  [[nodiscard]] MeshPointer findLog(std::string_view digest) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The mesh's file in `folder`; nullopt where `id` cannot be a file's name there: empty, with a
/// slash, a control byte or a leading dot, too long, or not UTF-8.
[[nodiscard]] std::optional<std::filesystem::path> pathOfMesh(const std::filesystem::path& folder,
                                                              std::string_view id);

}  // namespace qtet

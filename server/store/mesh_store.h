// The logs of one folder that are served, checked and opened on demand. Immutable snapshots follow
// the folder's changes (folder_watch.h).
#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/mesh_entry.h"
#include "server/store/served_mesh.h"

namespace qtet {

namespace limits {
/// One scan of a folder reads files for this time, and at least this many of them. The start waits
/// for one scan; a folder of 100,000 logs takes many.
inline constexpr auto kFolderReadTime = std::chrono::seconds(1);
/// Ids that were asked for and are read first: as many as clients may ask for in such a time.
inline constexpr std::size_t kMaxWantedLogs = 1000;
inline constexpr std::size_t kLogsReadAtOnce = 64;
}  // namespace limits

/// The meshes that are served at one moment.
struct Catalogue {
  /// A file that is not served, and why.
  struct Refused {
    std::filesystem::path path;
    FileIdentity file;
    Error error;
  };
  using Meshes = std::map<std::string, EntryPointer, std::less<>>;

  Meshes meshes;  ///< by id
  Meshes logs;    ///< by digest, with those that were replaced a short while ago
  std::vector<Refused> refused;
  /// Ids of files that nobody has looked into yet, in order; the next rescans do.
  std::vector<std::string> unread;
  std::string etag;         ///< changes with the ids and their logs; without quotes
  std::time_t changed = 0;  ///< seconds since 1970
};
using CataloguePointer = std::shared_ptr<const Catalogue>;

/// The result of `rescan`.
struct FolderChange {
  std::vector<EntryPointer> added;  ///< new or replaced
  std::vector<std::string> removed;
  std::vector<Catalogue::Refused> refused;  ///< newly
  [[nodiscard]] bool any() const { return !added.empty() || !removed.empty(); }
};

struct StoreOptions {
  /// Logs held open at a time, but for those that clients are reading: a descriptor each.
  std::size_t maxOpen = descriptorsForLogs();
  /// After this time a scan of the folder leaves the remaining files to the next scan. It always
  /// reads the first limits::kLogsReadAtOnce.
  std::chrono::milliseconds readTime = limits::kFolderReadTime;

  /// A quarter of what the process may open, and at most limits::kMaxOpenLogs: the rest is for
  /// clients.
  [[nodiscard]] static std::size_t descriptorsForLogs();
};

/// Thread-safe but for moves.
class MeshStore {
 public:
  /// No folder and no meshes.
  MeshStore();
  MeshStore(MeshStore&&) noexcept;
  MeshStore& operator=(MeshStore&&) noexcept;
  ~MeshStore();

  /// Checks every `*.qtet` of `folder` (not below it, and no link that leads out of it), as far as
  /// the time allows. Damaged ones end up in `refused`. Errors: io (the folder cannot be read).
  [[nodiscard]] static Result<MeshStore> open(const std::filesystem::path& folder,
                                              const StoreOptions& options = {});

  /// Looks at the folder again; opens what is new or has changed. A damaged file that took the
  /// place of a sound one leaves the sound one served, if it is open. `first` is the id that is
  /// looked at before all others. Errors: io (the folder cannot be read; everything stays as it
  /// was).
  [[nodiscard]] Result<FolderChange> rescan(std::string_view first = "") const;

  [[nodiscard]] const std::filesystem::path& folder() const;
  [[nodiscard]] CataloguePointer catalogue() const;
  /// nullptr when there is none of that name, or it cannot be opened now.
  [[nodiscard]] MeshPointer find(std::string_view id) const;
  /// nullptr when there is none of that digest.
  [[nodiscard]] MeshPointer findLog(std::string_view digest) const;
  /// Whether a mesh that find() or findLog() did not find may be found soon. Either the log is
  /// known but cannot be opened now, or nobody has looked into its file yet. An id that is asked
  /// for so is among the first that the next rescan looks at.
  [[nodiscard]] bool mayHave(std::string_view id) const;
  [[nodiscard]] bool mayHaveLog(std::string_view digest) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The mesh's file in `folder`; nullopt if `id` cannot be a file's name there. Such ids are empty,
/// too long or not UTF-8, or have a slash, a control byte or a leading dot.
[[nodiscard]] std::optional<std::filesystem::path> pathOfMesh(const std::filesystem::path& folder,
                                                              std::string_view id);

}  // namespace qtet

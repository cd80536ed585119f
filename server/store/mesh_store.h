// The logs of one folder that are served, checked and opened on demand. Immutable snapshots follow
// the folder's changes (folder_watch.h).
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/catalogue.h"
#include "server/store/served_mesh.h"

namespace qtet {

namespace limits {
/// The start waits so long for the folder's names: a million from a local disk.
inline constexpr auto kFolderNameTime = std::chrono::seconds(3);
/// One look at a folder reads files for this time, and at least kLogsReadAtOnce of them. The start
/// waits for one look, so a small folder is complete at once.
inline constexpr auto kFolderReadTime = std::chrono::milliseconds(200);
inline constexpr std::size_t kLogsReadAtOnce = 64;
/// An unread log up to so many bytes is read by the request that asks for it, within a few ms. A
/// larger one would hold up other clients of the same thread.
inline constexpr std::uintmax_t kMaxReadWhenAsked = 1u << 20;
/// Ids of larger logs that were asked for and are read first: as many as clients may ask for in
/// such a time.
inline constexpr std::size_t kMaxWantedLogs = 1000;
}  // namespace limits

/// The result of a look at the folder.
struct FolderChange {
  std::vector<EntryPointer> added;  ///< new or replaced
  std::vector<std::string> removed;
  std::vector<RefusedPointer> refused;  ///< newly
  [[nodiscard]] bool any() const { return !added.empty() || !removed.empty(); }
};

struct StoreOptions {
  /// Logs held open at a time, but for those that clients are reading: a descriptor each.
  std::size_t maxOpen = descriptorsForLogs();
  /// After this time a look at the folder leaves the remaining files to the next one. It always
  /// reads the first limits::kLogsReadAtOnce.
  std::chrono::milliseconds readTime = limits::kFolderReadTime;
  /// After this time the start leaves the remaining names to readOn().
  std::chrono::milliseconds nameTime = limits::kFolderNameTime;
  std::uintmax_t maxReadWhenAsked = limits::kMaxReadWhenAsked;

  /// A quarter of what the process may open, and at most limits::kMaxOpenLogs: the rest is for
  /// clients.
  [[nodiscard]] static std::size_t descriptorsForLogs();
};

/// Thread-safe but for moves: readers take an immutable snapshot, which a mutex guards while it is
/// replaced.
class MeshStore {
 public:
  /// No folder and no meshes.
  MeshStore();
  MeshStore(MeshStore&&) noexcept;
  MeshStore& operator=(MeshStore&&) noexcept;
  ~MeshStore();

  /// Learns the names of every `*.qtet` of `folder` (not below it, and no link that leads out of
  /// it), and checks the files, both as far as the time allows. Damaged ones end up in `refused`.
  /// Errors: io (the folder cannot be read).
  [[nodiscard]] static Result<MeshStore> open(const std::filesystem::path& folder,
                                              const StoreOptions& options = {});

  /// Learns the names again; opens what is new or has changed, and then what is unread. A damaged
  /// file that took the place of a sound one leaves the sound one served, if it is open. `first` is
  /// the id that is looked at before all others. Errors: io (the folder cannot be read; everything
  /// stays as it was).
  [[nodiscard]] Result<FolderChange> rescan(std::string_view first = "") const;
  /// Learns further names, if some are unknown, and opens what is unread: one look's work. Does not
  /// look at the logs that are served. Errors: as those of rescan().
  [[nodiscard]] Result<FolderChange> readOn() const;
  /// Waits for `rest`, or until somebody asks for an id that is unread, and then until readOn() has
  /// something to do. False: `stop` was requested.
  [[nodiscard]] bool awaitUnread(const std::stop_token& stop,
                                 std::chrono::steady_clock::duration rest) const;

  [[nodiscard]] const std::filesystem::path& folder() const;
  [[nodiscard]] CataloguePointer catalogue() const;
  /// Reads the log first if it is unread and not too large. nullptr when there is none of that
  /// name, or it cannot be opened now.
  [[nodiscard]] MeshPointer find(std::string_view id) const;
  /// nullptr when there is none of that digest.
  [[nodiscard]] MeshPointer findLog(std::string_view digest) const;
  /// Whether a mesh that find() or findLog() did not find may be found soon. Either the log is
  /// known but cannot be opened now, or nobody has looked into its file yet. An id that is asked
  /// for so is among the first that the next look reads.
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

// A log of the folder. The entry keeps the results of its check and opens the log on demand. So a
// folder may have many more logs than a process may have open files.
#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/store/served_mesh.h"

namespace qtet {

class MeshEntry;
using EntryPointer = std::shared_ptr<const MeshEntry>;

/// Which logs are held open, the least recently used of which is let go for another. Thread-safe:
/// `mutex_` guards the list.
class OpenMeshes {
 public:
  /// At least one.
  explicit OpenMeshes(std::size_t most) : most_(most) { assert(most > 0); }

  /// A number above all that it gave before.
  [[nodiscard]] std::uint64_t nextUse() { return ++uses_; }
  /// `entry` holds its log open from now on.
  void add(const EntryPointer& entry);
  /// Has all of them let go: the process has no descriptor left.
  void releaseAll();
  [[nodiscard]] bool full() const;

 private:
  const std::size_t most_;
  std::atomic<std::uint64_t> uses_ = 0;
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<const MeshEntry>> held_;
};

/// Thread-safe. About 2 KB while its log is not open.
class MeshEntry : public std::enable_shared_from_this<MeshEntry> {
 public:
  /// `mesh` is a checked log; the entry does not keep it open. `open` counts the log whenever the
  /// entry opens it.
  MeshEntry(const ServedMesh& mesh, std::filesystem::path path, std::shared_ptr<OpenMeshes> open);

  const std::filesystem::path path;
  const std::string id;
  const std::string digest;  ///< of the log, SHA-256 in lower-case hexadecimal
  const FileIdentity file;
  const std::string listEntry;  ///< its object in the list of meshes
  const std::uint64_t bytes, tetrahedra;
  const std::size_t levels;

  /// The log. Opened again, if need be, without comparing its checksums once more: the file is the
  /// one that was checked. nullptr: it cannot be opened now, or is another one by now.
  [[nodiscard]] MeshPointer open() const;
  /// Takes over the log, open already.
  void hold(MeshPointer mesh) const;
  /// Lets it go; who has it keeps it.
  void release() const;
  /// Keeps the log open as long as the entry lives, because its file has lost its name. False: it
  /// is not open, so it is lost.
  bool pin() const;
  [[nodiscard]] std::uint64_t lastUse() const { return lastUse_; }

 private:
  Result<MeshPointer> tryToOpen() const;

  const std::shared_ptr<OpenMeshes> openMeshes_;
  mutable std::atomic<std::uint64_t> lastUse_ = 0;
  mutable std::mutex mutex_;
  mutable MeshPointer held_;                      // guarded by `mutex_`, as what follows
  mutable std::weak_ptr<const ServedMesh> lent_;  // somebody may have it though it was let go
  mutable bool pinned_ = false;
};

}  // namespace qtet

// The meshes that are served at one moment.
#pragma once

#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/error.h"
#include "server/store/mesh_entry.h"
#include "server/store/sorted_blocks.h"
#include "server/wire/digest.h"

namespace qtet {

/// A file that is not served, and why.
struct RefusedFile {
  std::string id;
  std::filesystem::path path;
  FileIdentity file;
  Error error;
};
using RefusedPointer = std::shared_ptr<const RefusedFile>;

/// Immutable once others see it. A copy is cheap: it shares almost everything with the original.
struct Catalogue {
  struct IdOf {
    std::string_view operator()(const std::string& id) const { return id; }
    std::string_view operator()(const EntryPointer& mesh) const { return mesh->id; }
    std::string_view operator()(const RefusedPointer& file) const { return file->id; }
  };
  struct LogOf {
    std::pair<std::string_view, std::string_view> operator()(const EntryPointer& mesh) const {
      return {mesh->digest, mesh->id};
    }
  };
  using Meshes = SortedBlocks<EntryPointer, IdOf>;

  Meshes meshes;
  /// By digest and id, with those that were replaced a short while ago.
  SortedBlocks<EntryPointer, LogOf> logs;
  SortedBlocks<RefusedPointer, IdOf> refused;
  /// Ids of files that nobody has looked into yet.
  SortedBlocks<std::string, IdOf> unread;
  bool named = false;       ///< the folder's names are known
  Digest content{};         ///< of all ids and their digests, in no order
  std::time_t changed = 0;  ///< `meshes`, in seconds since 1970

  /// Whether the list lacks nothing.
  [[nodiscard]] bool complete() const { return named && unread.empty(); }
  /// Changes with the ids and their logs; without quotes.
  [[nodiscard]] std::string etag() const;
  /// nullptr: no log has that digest.
  [[nodiscard]] EntryPointer findLog(std::string_view digest) const;

  /// Serves `mesh` under its id, and returns the one that was served so far.
  EntryPointer put(const EntryPointer& mesh);
  /// Serves `id` no more, and returns what was served.
  EntryPointer drop(std::string_view id);
  /// Adds to `unread`. REQUIRES: sorted, each once.
  void leaveUnread(std::vector<std::string> ids);

 private:
  void count(const MeshEntry& mesh);
};
using CataloguePointer = std::shared_ptr<const Catalogue>;

}  // namespace qtet

// Pages that are the same for whoever may see them, made and compressed once and kept for a while.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/wire/document.h"

namespace qtet {

namespace limits {
/// Bytes of all kept pages: a page of the list has up to 1 MB, and a tenth of it compressed.
inline constexpr std::size_t kMaxKeptPageBytes = 16u << 20;
/// Bytes of all kept pages of meshes: about 500 of 2 kB.
inline constexpr std::size_t kMaxMeshPageBytes = 1u << 20;
}  // namespace limits

/// A page in one coding, with the head of its answer.
struct KeptPage {
  DocumentForm form{};

  /// With what the map and the list take.
  [[nodiscard]] std::size_t cost() const {
    return form.bytes.size() + form.headers.text().size() + 512;
  }
};
using KeptPagePointer = std::shared_ptr<const KeptPage>;

/// Holds at most `maxBytes`, without those that were not used for longest. Thread-safe: `mutex_`
/// guards it.
class KeptPages {
 public:
  explicit KeptPages(std::size_t maxBytes = limits::kMaxKeptPageBytes) : maxBytes_(maxBytes) {}

  /// nullptr: it is not kept.
  [[nodiscard]] KeptPagePointer find(const std::string& key);
  /// Does not keep a page that is larger than all may be, nor a second one of a key.
  void keep(const std::string& key, KeptPagePointer page);
  /// `KeptPage::cost` of all.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Entry {
    KeptPagePointer page;
    std::list<std::string>::iterator use;
  };

  const std::size_t maxBytes_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> pages_;
  std::list<std::string> uses_;  // keys, the latest used first
  std::size_t bytes_ = 0;
};

}  // namespace qtet

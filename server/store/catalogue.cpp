#include "server/store/catalogue.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <iterator>

namespace qtet {

std::string Catalogue::etag() const { return tagOf(ByteView(content)); }

EntryPointer Catalogue::findLog(std::string_view digest) const {
  const auto at = logs.lowerBound({digest, ""});
  return at != logs.end() && (*at)->digest == digest ? *at : nullptr;
}

/// A second call takes back the first.
void Catalogue::count(const MeshEntry& mesh) {
  const Digest part = digestOf(std::to_string(mesh.id.size()) + ':' + mesh.id + mesh.digest);
  for (std::size_t i = 0; i < part.size(); ++i) content[i] ^= part[i];
  changed = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
}

EntryPointer Catalogue::put(const EntryPointer& mesh) {
  assert(mesh);
  EntryPointer old = drop(mesh->id);
  meshes.put(mesh);
  logs.put(mesh);
  count(*mesh);
  return old;
}

EntryPointer Catalogue::drop(std::string_view id) {
  const EntryPointer* found = meshes.find(id);
  if (found == nullptr) return nullptr;
  EntryPointer old = *found;
  meshes.remove(id);
  [[maybe_unused]] const bool wasLog = logs.remove(LogOf()(old));
  assert(wasLog);
  count(*old);
  return old;
}

void Catalogue::leaveUnread(std::vector<std::string> ids) {
  if (ids.empty()) return;
  if (!unread.empty()) {
    std::vector<std::string> both;
    both.reserve(unread.size() + ids.size());
    std::ranges::set_union(unread, ids, std::back_inserter(both));
    ids.swap(both);
  }
  unread = decltype(unread)::ofSorted(std::move(ids));
}

}  // namespace qtet

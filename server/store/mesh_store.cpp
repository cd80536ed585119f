#include "server/store/mesh_store.h"

#include <sys/resource.h>

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <mutex>
#include <set>

#include "proto/json_reader.h"
#include "proto/utf8.h"
#include "server/store/folder_names.h"
#include "server/store/store_limits.h"
#include "server/wire/id_limits.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Ids = std::set<std::string, std::less<>>;

/// The result of a look at a file.
struct Found {
  std::string id;
  fs::path path;
  std::optional<FileIdentity> file;  ///< nullopt: it has gone
  Result<EntryPointer> mesh = nullptr;
};

/// Whether the old log may stay under its name: its own file is untouched (renamed over, not
/// written into) and still open.
bool staysSound(const MeshEntry& old, const FileIdentity& file) {
  return old.file.inode != file.inode && old.pin();
}

void drop(Catalogue& catalogue, const std::string& id, FolderChange& change) {
  if (catalogue.drop(id)) change.removed.push_back(id);
}

/// Names that the folder has, against what is known of it.
struct Comparison {
  std::vector<std::string> toRead, gone;
};

/// REQUIRES: sorted names.
Comparison compare(const fs::path& folder, std::vector<std::string> names,
                   const Catalogue& before) {
  Comparison out;
  const auto isGone = [&](std::string_view id) { return !std::ranges::binary_search(names, id); };
  const auto addGone = [&](const auto& known) {
    for (const auto& value : known)
      if (isGone(Catalogue::IdOf()(value))) out.gone.emplace_back(Catalogue::IdOf()(value));
  };
  addGone(before.meshes);
  addGone(before.refused);
  addGone(before.unread);
  const auto isSettled = [&](const std::string& id) {
    const EntryPointer* mesh = before.meshes.find(id);
    const RefusedPointer* refused = before.refused.find(id);
    if (mesh == nullptr && refused == nullptr) return before.unread.contains(id);
    const auto file = identityOf(folder / (id + std::string(kLogSuffix)));
    // A file that could not be read may be readable now; a damaged one stays damaged.
    return !file || (mesh != nullptr && (*mesh)->file == *file) ||
           (refused != nullptr && (*refused)->file == *file &&
            (*refused)->error.code != ErrorCode::kIo);
  };
  std::erase_if(names, isSettled);
  out.toRead = std::move(names);
  return out;
}

}  // namespace

struct MeshStore::State {
  fs::path folder;
  StoreOptions options{};
  std::shared_ptr<OpenMeshes> open = std::make_shared<OpenMeshes>(1);

  std::mutex scanning;                 ///< one look at the folder at a time
  std::optional<FolderNames> names{};  ///< not read to their end; guarded by `scanning`

  /// One change of the catalogue at a time; requests that read a log wait for it, others do not.
  std::mutex changing;
  /// Replaced logs, and until when they are to be had under their digests. Guarded by `changing`.
  std::vector<std::pair<Clock::time_point, EntryPointer>> retired{};
  FolderChange news{};  ///< of requests, for the next look to report; guarded by `changing`

  mutable std::mutex mutex;
  CataloguePointer current = std::make_shared<Catalogue>();  // guarded by `mutex`
  Ids wanted{};                                              // guarded by `mutex`
  std::condition_variable_any work{};                        // of `current` and `wanted`

  CataloguePointer snapshot() const {
    const std::scoped_lock lock(mutex);
    return current;
  }
  /// Publishes a copy of the catalogue that `edit` has changed.
  template <class Edit>
  void change(Edit edit) {
    const std::scoped_lock lock(changing);
    auto next = std::make_shared<Catalogue>(*snapshot());
    edit(*next);
    const std::scoped_lock swap(mutex);
    current = std::move(next);
    work.notify_all();
  }

  void want(std::string_view id) {
    const std::scoped_lock lock(mutex);
    if (wanted.size() < limits::kMaxWantedLogs) wanted.emplace(id);
    work.notify_all();
  }
  /// Ids to be looked at before all others, which are forgotten by this.
  Ids takeWanted(std::string_view first) {
    Ids out;
    const std::scoped_lock lock(mutex);
    out.swap(wanted);
    if (!first.empty()) out.emplace(first);
    return out;
  }

  [[nodiscard]] bool isUnread(const Catalogue& now, std::string_view id) const;
  [[nodiscard]] Found look(const std::string& id) const;
  void settle(const Found& found, Catalogue& next, FolderChange& change);
  void retire(const EntryPointer& old, Catalogue& next);
  void forgetRetired(Catalogue& next);
  MeshPointer readNow(const std::string& id);
  [[nodiscard]] Status beginNames();
  FolderChange read(Comparison difference, bool named, std::string_view first);
  Result<FolderChange> lookAtNames(Clock::time_point end, std::string_view first);
};

/// While the names are not known, the folder itself says whether there is such a file.
bool MeshStore::State::isUnread(const Catalogue& now, std::string_view id) const {
  if (now.named || now.refused.contains(id)) return now.unread.contains(id);
  const std::optional<fs::path> path = pathOfMesh(folder, id);
  std::error_code ec;
  return path && isServable(*path, fs::canonical(folder, ec));
}

Found MeshStore::State::look(const std::string& id) const {
  Found out{id, folder / (id + std::string(kLogSuffix)), {}};
  out.file = identityOf(out.path);
  if (!out.file) return out;
  const bool holds = !open->full();
  Result<MeshPointer> mesh = openMesh(out.path, id, holds);
  if (!mesh) {
    out.mesh = std::unexpected(mesh.error());
    return out;
  }
  auto entry = std::make_shared<const MeshEntry>(**mesh, out.path, open);
  if (holds) entry->hold(std::move(*mesh));
  out.mesh = std::move(entry);
  return out;
}

void MeshStore::State::settle(const Found& found, Catalogue& next, FolderChange& change) {
  next.unread.remove(found.id);
  if (!found.file) {
    next.refused.remove(found.id);
    return drop(next, found.id, change);
  }
  const EntryPointer* known = next.meshes.find(found.id);
  if (!found.mesh) {
    next.refused.put(std::make_shared<const RefusedFile>(
        RefusedFile{found.id, found.path, *found.file, found.mesh.error()}));
    change.refused.push_back(*next.refused.find(found.id));
    if (known != nullptr && !staysSound(**known, *found.file)) drop(next, found.id, change);
    return;
  }
  if (known != nullptr && (*known)->file == (*found.mesh)->file) return;  // a request was faster
  next.refused.remove(found.id);
  if (const EntryPointer old = next.put(*found.mesh)) retire(old, next);
  change.added.push_back(*found.mesh);
}

void MeshStore::State::retire(const EntryPointer& old, Catalogue& next) {
  assert(old);
  if (!old->pin()) return;  // its file has gone: it cannot be had any more
  retired.emplace_back(Clock::now() + limits::kReplacedLogTime, old);
  if (!next.logs.contains(Catalogue::LogOf()(old))) next.logs.put(old);
}

void MeshStore::State::forgetRetired(Catalogue& next) {
  const auto now = Clock::now();
  const auto over = std::ssize(retired) - std::ptrdiff_t{limits::kMaxReplacedLogs};
  for (std::ptrdiff_t i = 0; i < std::ssize(retired); ++i) {
    auto& [until, mesh] = retired[static_cast<std::size_t>(i)];
    if (i >= over && until > now) continue;
    const EntryPointer* kept = next.logs.find(Catalogue::LogOf()(mesh));
    const EntryPointer* served = next.meshes.find(mesh->id);
    if (kept != nullptr && *kept == mesh && (served == nullptr || *served != mesh))
      next.logs.remove(Catalogue::LogOf()(mesh));
    mesh = nullptr;
  }
  std::erase_if(retired, [](const auto& entry) { return entry.second == nullptr; });
}

/// On the thread of a request. nullptr: there is none, it is damaged, or too large for that.
MeshPointer MeshStore::State::readNow(const std::string& id) {
  const auto file = identityOf(folder / (id + std::string(kLogSuffix)));
  if (file && static_cast<std::uintmax_t>(file->bytes) > options.maxReadWhenAsked) return nullptr;
  const Found found = look(id);
  change([&](Catalogue& next) {
    settle(found, next, news);
    forgetRetired(next);
  });
  return found.mesh && *found.mesh ? (*found.mesh)->open() : nullptr;
}

/// Reads what is wanted, then what is new, then what is unread, in one look's time.
FolderChange MeshStore::State::read(Comparison difference, bool named, std::string_view first) {
  const CataloguePointer before = snapshot();
  const Clock::time_point end = Clock::now() + options.readTime;
  std::vector<Found> found;
  const auto mayRead = [&](std::size_t least) {
    return found.size() < least || Clock::now() < end;
  };
  std::vector<std::string>& toRead = difference.toRead;
  const Ids urgent = takeWanted(first);
  const auto isUrgent = [&](const std::string& id) { return urgent.contains(id); };
  if (!urgent.empty()) std::ranges::sort(std::ranges::partition(toRead, isUrgent));
  for (const std::string& id : urgent)
    if (isUnread(*before, id)) mayRead(1) ? found.push_back(look(id)) : want(id);
  auto next = toRead.begin();
  while (next != toRead.end() && mayRead(limits::kLogsReadAtOnce)) found.push_back(look(*next++));
  for (auto at = before->unread.begin(); at != before->unread.end() && mayRead(1); ++at)
    if (!isUrgent(*at)) found.push_back(look(*at));
  toRead.erase(toRead.begin(), next);
  std::ranges::sort(toRead);

  FolderChange out;
  change([&](Catalogue& now) {
    std::swap(out, news);
    now.named = now.named || named;
    if (now.changed == 0) now.changed = std::time(nullptr);
    for (const std::string& id : difference.gone) {
      now.refused.remove(id);
      now.unread.remove(id);
      drop(now, id, out);
    }
    for (const Found& file : found) settle(file, now, out);
    for (const std::string& id : toRead)
      if (const EntryPointer* old = now.meshes.find(id)) {
        const auto file = identityOf((*old)->path);
        if (file && !staysSound(**old, *file)) drop(now, id, out);
      }
    now.leaveUnread(std::move(toRead));
    forgetRetired(now);
  });
  return out;
}

/// REQUIRES: `scanning`, as the next.
Status MeshStore::State::beginNames() {
  Result<FolderNames> begun = FolderNames::open(folder);
  if (!begun) return std::unexpected(begun.error());
  names.emplace(std::move(*begun));
  return {};
}

/// REQUIRES: `names`.
Result<FolderChange> MeshStore::State::lookAtNames(Clock::time_point end, std::string_view first) {
  assert(names);
  const Result<bool> whole = names->read(end);
  if (!whole) {
    names.reset();
    return std::unexpected(whole.error());
  }
  if (!*whole) return read({}, false, first);
  std::vector<std::string> ids = std::move(*names).take();
  names.reset();
  return read(compare(folder, std::move(ids), *snapshot()), true, first);
}

MeshStore::MeshStore() : state_(std::make_unique<State>()) {}
MeshStore::MeshStore(MeshStore&&) noexcept = default;
MeshStore& MeshStore::operator=(MeshStore&&) noexcept = default;
MeshStore::~MeshStore() = default;

std::size_t StoreOptions::descriptorsForLogs() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return limits::kMaxOpenLogs;
  return std::clamp<std::size_t>(limit.rlim_cur / 4, 1, limits::kMaxOpenLogs);
}

Result<MeshStore> MeshStore::open(const fs::path& folder, const StoreOptions& options) {
  MeshStore out;
  State& state = *out.state_;
  state.folder = folder;
  state.options = options;
  state.open = std::make_shared<OpenMeshes>(options.maxOpen);
  const std::scoped_lock lock(state.scanning);
  if (const Status begun = state.beginNames(); !begun) return std::unexpected(begun.error());
  const Result<FolderChange> found = state.lookAtNames(Clock::now() + options.nameTime, "");
  if (!found) return std::unexpected(found.error());
  return out;
}

Result<FolderChange> MeshStore::rescan(std::string_view first) const {
  const std::scoped_lock lock(state_->scanning);
  if (const Status begun = state_->beginNames(); !begun) return std::unexpected(begun.error());
  return state_->lookAtNames(Clock::time_point::max(), first);
}

Result<FolderChange> MeshStore::readOn() const {
  const std::scoped_lock lock(state_->scanning);
  if (!state_->names && state_->snapshot()->named) return state_->read({}, false, "");
  if (!state_->names)  // an error ended the reading of names
    if (const Status begun = state_->beginNames(); !begun) return std::unexpected(begun.error());
  return state_->lookAtNames(Clock::now() + state_->options.readTime, "");
}

bool MeshStore::awaitUnread(const std::stop_token& stop, Clock::duration rest) const {
  std::unique_lock lock(state_->mutex);
  state_->work.wait_for(lock, stop, rest, [this] { return !state_->wanted.empty(); });
  state_->work.wait(lock, stop, [this] { return !state_->current->complete(); });
  return !stop.stop_requested();
}

const fs::path& MeshStore::folder() const { return state_->folder; }
CataloguePointer MeshStore::catalogue() const { return state_->snapshot(); }

MeshPointer MeshStore::find(std::string_view id) const {
  const CataloguePointer now = catalogue();
  if (const EntryPointer* mesh = now->meshes.find(id)) return (*mesh)->open();
  return state_->isUnread(*now, id) ? state_->readNow(std::string(id)) : nullptr;
}

MeshPointer MeshStore::findLog(std::string_view digest) const {
  const EntryPointer mesh = catalogue()->findLog(digest);
  return mesh ? mesh->open() : nullptr;
}

bool MeshStore::mayHave(std::string_view id) const {
  const CataloguePointer now = catalogue();
  if (!state_->isUnread(*now, id)) return now->meshes.contains(id);
  state_->want(id);
  return true;
}

bool MeshStore::mayHaveLog(std::string_view digest) const {
  const CataloguePointer now = catalogue();
  return !now->complete() || now->findLog(digest) != nullptr;
}

std::optional<fs::path> pathOfMesh(const fs::path& folder, std::string_view id) {
  if (id.empty() || id.size() > limits::kMaxIdBytes || id.front() == '.' ||
      id.find_first_of("/\\") != std::string_view::npos || hasControl(id))
    return std::nullopt;
  // dumpJson replaces what is not UTF-8, so a name that survives it is.
  if (Json::parse(dumpJson(Json(std::string(id)))).get<std::string>() != id) return std::nullopt;
  return folder / (std::string(id) + std::string(kLogSuffix));
}

}  // namespace qtet

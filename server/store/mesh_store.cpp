#include "server/store/mesh_store.h"

#include <sys/resource.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <set>

#include "proto/json_reader.h"
#include "server/store/store_limits.h"
#include "server/wire/digest.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kSuffix = ".qtet";

/// Whether the file that `path` leads to, links resolved, lies in `root` (resolved already).
bool liesIn(const fs::path& path, const fs::path& root) {
  std::error_code ec;
  const fs::path real = fs::canonical(path, ec);
  return !ec && std::ranges::mismatch(root, real).in1 == root.end();
}

Result<std::vector<fs::path>> listLogs(const fs::path& folder) {
  std::error_code ec;
  const fs::path root = fs::canonical(folder, ec);
  std::vector<fs::path> out;
  if (!ec)
    for (fs::directory_iterator it(root, ec), end; !ec && it != end; it.increment(ec)) {
      std::error_code gone;
      const bool candidate =
          it->path().extension() == kSuffix && !it->path().filename().native().starts_with('.');
      if (candidate && it->is_regular_file(gone) &&
          (!it->is_symlink(gone) || liesIn(it->path(), root)))
        out.push_back(it->path());
    }
  if (ec)
    return fail(ErrorCode::kIo,
                folder.string() + ": " + ec.message() + "; name a folder that holds .qtet files");
  std::ranges::sort(out);
  return out;
}

/// The tag of a list: what stands in it decides.
std::string listTag(const Catalogue::Meshes& meshes) {
  std::string all;
  for (const auto& [id, mesh] : meshes) all += std::to_string(id.size()) + ':' + id + mesh->digest;
  return hexDigestOf(all);
}

/// Builds a catalogue out of the one before and the folder.
class Scan {
 public:
  Scan(const Catalogue& before, std::chrono::milliseconds time, std::shared_ptr<OpenMeshes> open)
      : before_(before),
        open_(std::move(open)),
        end_(Clock::now() + time),
        next_(std::make_shared<Catalogue>()) {}

  void look(const fs::path& path) {
    const std::optional<FileIdentity> file = identityOf(path);
    if (!file) return;  // gone since the folder was read
    const std::string id = path.stem().string();
    const auto known = before_.meshes.find(id);
    const EntryPointer old = known == before_.meshes.end() ? nullptr : known->second;
    if (old && old->file == *file) return keep(old);
    // A file that could not be read may be readable now; a damaged one stays damaged.
    const auto refused = std::ranges::find_if(before_.refused, [&](const auto& r) {
      return r.path == path && r.file == *file && r.error.code != ErrorCode::kIo;
    });
    if (refused != before_.refused.end()) {
      next_->refused.push_back(*refused);
      return keepSound(old, *file);
    }
    if (++read_ > limits::kLogsReadAtOnce && Clock::now() > end_) {
      next_->unread.push_back(id);
      return old ? keepSound(old, *file) : void();
    }
    const bool holds = !open_->full();
    Result<MeshPointer> mesh = openMesh(path, id, holds);
    if (mesh) return add(path, std::move(*mesh), holds);
    next_->refused.push_back({path, *file, mesh.error()});
    change_.refused.push_back(next_->refused.back());
    keepSound(old, *file);
  }

  void finish() {
    for (const auto& [id, mesh] : before_.meshes)
      if (!next_->meshes.contains(id)) change_.removed.push_back(id);
    for (const auto& [id, mesh] : next_->meshes) next_->logs.emplace(mesh->digest, mesh);
    std::ranges::sort(next_->unread);
    next_->etag = listTag(next_->meshes);
    const bool first = before_.etag.empty();
    next_->changed = first || change_.any()
                         ? std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())
                         : before_.changed;
  }

  [[nodiscard]] const std::shared_ptr<Catalogue>& next() const { return next_; }
  [[nodiscard]] FolderChange& change() { return change_; }

 private:
  void add(const fs::path& path, MeshPointer mesh, bool holds) {
    const auto entry = std::make_shared<const MeshEntry>(*mesh, path, open_);
    if (holds) entry->hold(std::move(mesh));
    next_->meshes[entry->id] = entry;
    change_.added.push_back(entry);
  }
  void keep(const EntryPointer& mesh) { next_->meshes[mesh->id] = mesh; }
  /// The old log stays under its name if its own file is untouched (renamed over, not written into)
  /// and still open.
  void keepSound(const EntryPointer& old, const FileIdentity& file) {
    if (old && old->file.inode != file.inode && old->pin()) keep(old);
  }

  const Catalogue& before_;
  const std::shared_ptr<OpenMeshes> open_;
  const Clock::time_point end_;
  std::size_t read_ = 0;  // files that were looked into
  std::shared_ptr<Catalogue> next_;
  FolderChange change_;
};

}  // namespace

struct MeshStore::State {
  fs::path folder;
  std::chrono::milliseconds readTime{};
  std::shared_ptr<OpenMeshes> open = std::make_shared<OpenMeshes>(1);
  std::mutex scanning;                          // one rescan at a time
  std::set<std::string, std::less<>> wanted{};  // ids, guarded by `mutex`
  /// Replaced logs, and until when they are to be had under their digests. Guarded by `scanning`.
  std::vector<std::pair<Clock::time_point, EntryPointer>> retired;
  mutable std::mutex mutex;
  CataloguePointer current = std::make_shared<Catalogue>();  // guarded by `mutex`

  CataloguePointer snapshot() const {
    const std::scoped_lock lock(mutex);
    return current;
  }
  void retire(const Catalogue& before, Catalogue& next);
  /// Ids to be looked at before all others, which are forgotten by this.
  std::set<std::string, std::less<>> takeWanted(std::string_view first) {
    std::set<std::string, std::less<>> out;
    const std::scoped_lock lock(mutex);
    out.swap(wanted);
    if (!first.empty()) out.emplace(first);
    return out;
  }
};

void MeshStore::State::retire(const Catalogue& before, Catalogue& next) {
  const auto now = Clock::now();
  std::erase_if(retired, [now](const auto& entry) { return entry.first <= now; });
  for (const auto& [id, mesh] : before.meshes) {
    const auto it = next.meshes.find(id);
    // its file has gone: unless it is open it cannot be had any more
    if (it != next.meshes.end() && it->second != mesh && mesh->pin())
      retired.emplace_back(now + limits::kReplacedLogTime, mesh);
  }
  while (retired.size() > limits::kMaxReplacedLogs) retired.erase(retired.begin());
  for (const auto& [until, mesh] : retired) next.logs.emplace(mesh->digest, mesh);
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
  out.state_->folder = folder;
  out.state_->readTime = options.readTime;
  out.state_->open = std::make_shared<OpenMeshes>(options.maxOpen);
  if (Result<FolderChange> found = out.rescan(); !found) return std::unexpected(found.error());
  return out;
}

Result<FolderChange> MeshStore::rescan(std::string_view first) const {
  const std::scoped_lock lock(state_->scanning);
  Result<std::vector<fs::path>> paths = listLogs(state_->folder);
  if (!paths) return std::unexpected(paths.error());
  if (const auto wanted = state_->takeWanted(first); !wanted.empty())
    std::ranges::partition(
        *paths, [&](const fs::path& path) { return wanted.contains(path.stem().native()); });
  const CataloguePointer before = state_->snapshot();
  Scan scan(*before, state_->readTime, state_->open);
  for (const fs::path& path : *paths) scan.look(path);
  scan.finish();
  state_->retire(*before, *scan.next());
  const std::scoped_lock swap(state_->mutex);
  state_->current = scan.next();
  return std::move(scan.change());
}

const fs::path& MeshStore::folder() const { return state_->folder; }
CataloguePointer MeshStore::catalogue() const { return state_->snapshot(); }

MeshPointer MeshStore::find(std::string_view id) const {
  const CataloguePointer now = catalogue();
  const auto it = now->meshes.find(id);
  return it == now->meshes.end() ? nullptr : it->second->open();
}

MeshPointer MeshStore::findLog(std::string_view digest) const {
  const CataloguePointer now = catalogue();
  const auto it = now->logs.find(digest);
  return it == now->logs.end() ? nullptr : it->second->open();
}

bool MeshStore::mayHave(std::string_view id) const {
  const CataloguePointer now = catalogue();
  if (!std::ranges::binary_search(now->unread, id)) return now->meshes.contains(id);
  const std::scoped_lock lock(state_->mutex);
  if (state_->wanted.size() < limits::kMaxWantedLogs) state_->wanted.emplace(id);
  return true;
}

bool MeshStore::mayHaveLog(std::string_view digest) const {
  const CataloguePointer now = catalogue();
  return !now->unread.empty() || now->logs.contains(digest);
}

std::optional<fs::path> pathOfMesh(const fs::path& folder, std::string_view id) {
  const bool odd = std::ranges::any_of(id, [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '/' || c == '\\';
  });
  if (id.empty() || id.size() > limits::kMaxIdBytes || id.front() == '.' || odd)
    return std::nullopt;
  // dumpJson replaces what is not UTF-8, so a name that survives it is.
  if (Json::parse(dumpJson(Json(std::string(id)))).get<std::string>() != id) return std::nullopt;
  return folder / (std::string(id) + std::string(kSuffix));
}

}  // namespace qtet

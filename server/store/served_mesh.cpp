#include "server/store/served_mesh.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>

#include "codec/log/log_levels.h"
#include "codec/log/log_manifest.h"
#include "server/store/descriptions.h"
#include "server/store/store_limits.h"
#include "server/wire/digest.h"

namespace qtet {

Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

std::uint64_t ServedMesh::prefixBytes(std::uint32_t level) const {
  assert(level < manifest.levels.size());
  return qtet::prefixBytes(manifest, log.index(), level);
}

struct ServedMesh::Texts {
  struct Made {
    std::once_flag once;
    std::atomic<bool> isMade = false;
    Document document;
  };
  std::array<Made, 2> byKind;  // by Text
  std::once_flag keysOnce;
  std::optional<FieldKeys> keys;
};

std::shared_ptr<ServedMesh::Texts> ServedMesh::makeTexts() { return std::make_shared<Texts>(); }

const Document& ServedMesh::text(Text which) const {
  Texts::Made& made = texts->byKind[static_cast<std::size_t>(which)];
  std::call_once(made.once, [&] {
    made.document =
        which == Text::kDescription
            ? Document(describeMesh(*this), {{"", modified}, "application/json", kRevalidate})
            : Document(manifestToJson(manifest), {{"", modified}, "application/json", kForEver});
    made.isMade = true;
  });
  return made.document;
}

bool ServedMesh::isQuick(Text which) const {
  if (texts->byKind[static_cast<std::size_t>(which)].isMade) return true;
  // Bytes of JSON. The description holds the manifest, and sums the blocks of each field.
  constexpr std::uint64_t kField = 400, kLevel = 300, kErrorOfField = 80, kMost = 64u << 10;
  const std::uint64_t fields = manifest.fields.size(), levels = manifest.levels.size();
  const std::uint64_t errors = manifest.levels.back().error ? fields * kErrorOfField : 0;
  return fields * kField + levels * (kLevel + errors) + fields * log.chunks().size() <= kMost;
}

const FieldKeys& ServedMesh::keys() const {
  std::call_once(texts->keysOnce,
                 [this] { texts->keys.emplace(manifest.fields, manifest.series); });
  return *texts->keys;
}

std::optional<FileIdentity> identityOf(const std::filesystem::path& path) {
  struct stat info{};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return FileIdentity{info.st_dev, info.st_ino, info.st_size, info.st_mtim};
}

namespace {

std::atomic<std::uintmax_t> copiedBytes = 0;

/// A part of what may be copied, given back with the last copy of the pointer; nullptr: there is
/// not enough left.
std::shared_ptr<void> takeCopy(std::uintmax_t bytes) {
  if (bytes > limits::kMaxCopiedLogBytes) return nullptr;
  if (copiedBytes.fetch_add(bytes) + bytes > limits::kMaxCopiedBytes)
    return copiedBytes.fetch_sub(bytes), nullptr;
  return {&copiedBytes, [bytes](void*) { copiedBytes.fetch_sub(bytes); }};
}

/// Whether all of them were copied; errno says why not, EIO where the file was cut short meanwhile.
bool copyInto(int copy, int file, std::uintmax_t bytes) {
  off_t offset = 0;
  while (static_cast<std::uintmax_t>(offset) < bytes) {
    const auto rest = static_cast<std::size_t>(bytes - static_cast<std::uintmax_t>(offset));
    // shares the blocks where the file system can
    ssize_t count = ::copy_file_range(file, &offset, copy, nullptr, rest, 0);
    if (count < 0) count = ::sendfile(copy, file, &offset, rest);
    if (count == 0) errno = EIO;
    if (count <= 0) return false;
  }
  return true;
}

/// Copies a file into one without a name, which nobody else can change. The copy lies beside the
/// original if possible: there the kernel can drop its pages, and sends them twice as fast as those
/// of memory. Else it lies in memory. Returns -1 and errno after an error.
int copyOf(int file, const std::filesystem::path& folder, std::uintmax_t bytes) {
  for (const bool beside : {true, false}) {
    const int copy = beside
                         ? ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR)
                         : ::memfd_create("qtet-log", MFD_CLOEXEC);
    if (copy < 0) continue;
    if (copyInto(copy, file, bytes)) return copy;
    ::close(copy);
  }
  return -1;
}

/// The file itself, or its copy.
Result<std::unique_ptr<Descriptor>> openFile(const std::filesystem::path& path,
                                             std::optional<std::uintmax_t> copiedBytesOfIt) {
  auto file = std::make_unique<Descriptor>(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file->number >= 0 && copiedBytesOfIt)
    file = std::make_unique<Descriptor>(copyOf(file->number, path.parent_path(), *copiedBytesOfIt));
  if (file->number < 0)
    return fail(ErrorCode::kIo, path.string() + ": cannot be read: " + std::strerror(errno));
  return file;
}

/// A LogFile takes a plain function for its digest: what it is to give where it is known.
thread_local const std::string* knownDigest = nullptr;

Result<LogFile> openLog(const Descriptor& file, const std::filesystem::path& path,
                        const std::string* digest) {
  const auto digestOf = [](ByteView bytes) {
    return knownDigest != nullptr ? *knownDigest : hexDigestOf(bytes);
  };
  knownDigest = digest;
  Result<LogFile> log = LogFile::map(file.number, path.string(), digestOf);
  knownDigest = nullptr;
  return log;
}

/// `digest` is nullptr where it is to be found out, and the checksums are to be compared.
Result<MeshPointer> openAs(const std::filesystem::path& path, std::string id,
                           const FileIdentity& file, const std::string* digest, bool copy) {
  const auto size = static_cast<std::uintmax_t>(file.bytes);
  std::shared_ptr<void> copied = copy && size > 0 ? takeCopy(size) : nullptr;
  auto descriptor = openFile(path, copied ? std::optional(size) : std::nullopt);
  if (!descriptor) return std::unexpected(descriptor.error());
  Result<LogFile> log = openLog(**descriptor, path, digest);
  if (!log) return std::unexpected(log.error());
  if (digest == nullptr)
    if (const Status whole = log->verifyChecksums(); !whole) return std::unexpected(whole.error());
  Result<Manifest> manifest = manifestOf(log->index());
  if (!manifest) return std::unexpected(manifest.error());
  auto out = std::make_shared<ServedMesh>(
      ServedMesh{std::move(id), std::move(*log), std::move(*manifest), file.modified.tv_sec, file});
  out->descriptor = std::move(*descriptor);
  out->copied = std::move(copied);
  return out;
}

}  // namespace

std::uintmax_t bytesOfCopies() { return copiedBytes; }

Result<MeshPointer> openMesh(const std::filesystem::path& path, std::string id, bool copy) {
  // Asked first: a file that changes while it is read differs from this identity, and is opened
  // again.
  return openAs(path, std::move(id), identityOf(path).value_or(FileIdentity()), nullptr, copy);
}

Result<MeshPointer> reopenMesh(const std::filesystem::path& path, std::string id,
                               const std::string& digest, const FileIdentity& file) {
  Result<MeshPointer> out = openAs(path, std::move(id), file, &digest, true);
  // Asked last: what was opened is what has this identity, before it was opened and behind it.
  if (out && identityOf(path) != file)
    return fail(ErrorCode::kIo, path.string() + ": has changed since the folder was read");
  return out;
}

}  // namespace qtet

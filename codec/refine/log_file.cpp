#include "codec/refine/log_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/manifest_field.h"
#include "codec/log/value_block.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/refiner.h"
#include "proto/checksum.h"
#include "proto/crc32c.h"
#include "proto/manifest.h"

namespace qtet {

struct LogFile::State {
  void* address = nullptr;
  std::size_t bytes = 0;
  Bytes owned;  // of a log that came as bytes; nothing is mapped then
  LogIndex index;
  std::string digest;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (address != nullptr) munmap(address, bytes);
  }
};

LogFile::LogFile(LogFile&&) noexcept = default;
LogFile& LogFile::operator=(LogFile&&) noexcept = default;
LogFile::~LogFile() = default;
LogFile::LogFile(std::unique_ptr<State> state) : state_(std::move(state)) {}

const LogIndex& LogFile::index() const { return state_->index; }
std::span<const ChunkEntry> LogFile::chunks() const { return state_->index.chunks; }
std::span<const FieldShape> LogFile::fields() const { return state_->index.fields; }
std::span<const ClosingBlock> LogFile::closingBlocks() const { return state_->index.closing; }
bool LogFile::hasClosing(ClosingKind kind, std::uint32_t field) const {
  return state_->index.closingBlock(kind, field) != nullptr;
}
std::uint64_t LogFile::headBytes() const { return state_->index.headBytes(); }
const std::string& LogFile::digest() const { return state_->digest; }

Result<LogFile> LogFile::open(const std::filesystem::path& path, DigestOf digestOf) {
  // of a pipe, without waiting for who writes
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return fail(ErrorCode::kIo, path.string() + ": cannot be opened: " + std::strerror(errno));
  Result<LogFile> log = map(file, path.string(), digestOf);
  ::close(file);
  return log;
}

Result<LogFile> LogFile::map(int file, const std::string& name, DigestOf digestOf) {
  const auto io = [&](const char* what) {
    return fail(ErrorCode::kIo, name + ": " + what + ": " + std::strerror(errno));
  };
  struct stat info{};
  if (::fstat(file, &info) != 0) return io("cannot be read");
  if (!S_ISREG(info.st_mode)) return fail(ErrorCode::kIo, name + ": not a regular file");
  if (info.st_size == 0) return fail(ErrorCode::kTruncated, name + ": the file is empty", 0);
  if (!std::in_range<std::size_t>(info.st_size))
    return fail(ErrorCode::kLimitExceeded,
                name + ": has " + std::to_string(info.st_size) +
                    " bytes, more than a program of 32 bits can address; use one of 64 bits");
  void* address =
      ::mmap(nullptr, static_cast<std::size_t>(info.st_size), PROT_READ, MAP_PRIVATE, file, 0);
  if (address == MAP_FAILED) return io("cannot be mapped into memory");
  auto state = std::make_unique<State>();
  state->address = address, state->bytes = static_cast<std::size_t>(info.st_size);

  Result<LogFile> log = checked(std::move(state), digestOf);
  if (!log) log.error().message = name + ": " + log.error().message;
  return log;
}

Result<LogFile> LogFile::fromBytes(Bytes bytes) {
  auto state = std::make_unique<State>();
  state->owned = std::move(bytes);
  return checked(std::move(state));
}

namespace {

// Bytes of a mapped file in memory at once, while its digest is made.
constexpr std::size_t kPieceBytes = 4 << 20;

std::string digestInPieces(const LogFile& log) {
  Sha256 sha;
  for (std::size_t at = 0; at < log.bytes().size(); at += kPieceBytes) {
    const std::size_t size = std::min(kPieceBytes, log.bytes().size() - at);
    sha.update(log.bytes().subspan(at, size));
    log.release(at, size);
  }
  return toHex(sha.finish());
}

}  // namespace

Result<LogFile> LogFile::checked(std::unique_ptr<State> state, DigestOf digestOf) {
  LogFile log(std::move(state));
  Result<LogIndex> index = LogIndex::parse(log.bytes());
  if (!index) return std::unexpected(index.error());
  if (index->fileBytes != log.bytes().size())
    return fail(
        index->fileBytes > log.bytes().size() ? ErrorCode::kTruncated : ErrorCode::kBadValue,
        "the file has " + std::to_string(log.bytes().size()) + " bytes, its header says " +
            std::to_string(index->fileBytes) + "; copy or fetch it again",
        log.bytes().size());
  log.state_->index = std::move(*index);
  log.state_->digest = digestOf != nullptr ? digestOf(log.bytes()) : digestInPieces(log);
  return log;
}

ByteView LogFile::bytes() const {
  if (state_->address == nullptr) return state_->owned;
  return {static_cast<const std::uint8_t*>(state_->address), state_->bytes};
}

ByteView LogFile::block(std::uint32_t chunk, std::uint32_t part) const {
  const BlockEntry& b = state_->index.block(chunk, part);
  return bytes().subspan(static_cast<std::size_t>(b.offset), b.size);
}

void LogFile::release(std::uint64_t offset, std::uint64_t size) const {
  if (state_->address == nullptr || size == 0) return;
  // whole pages, also of the neighbours, who can be read again
  static const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  assert(offset + size <= state_->bytes);
  const std::uint64_t begin = offset / page * page;
  madvise(static_cast<std::uint8_t*>(state_->address) + begin,
          static_cast<std::size_t>(offset + size - begin), MADV_DONTNEED);
}

namespace {

void releaseBlock(const LogFile& log, std::uint32_t chunk, std::uint32_t part) {
  const BlockEntry& b = log.index().block(chunk, part);
  log.release(b.offset, b.size);
}

Status checkBlock(const LogFile& log, std::uint32_t chunk, std::uint32_t part) {
  const BlockEntry& b = log.index().block(chunk, part);
  if (crc32c(log.block(chunk, part)) == b.crc) return {};
  return fail(ErrorCode::kBadChecksum,
              "chunk " + std::to_string(chunk) + ", part " + std::to_string(part) +
                  ": the CRC-32C does not match; fetch the file again",
              b.offset);
}

}  // namespace

Status LogFile::verifyChecksums() const {
  for (std::uint32_t chunk = 0; chunk < state_->index.chunks.size(); ++chunk)
    for (std::uint32_t part = 0; part < state_->index.parts(); ++part) {
      if (Status s = checkBlock(*this, chunk, part); !s) return s;
      releaseBlock(*this, chunk, part);
    }
  for (const ClosingBlock& c : state_->index.closing) {
    if (const auto bytes = closing(c.kind, c.field); !bytes) return std::unexpected(bytes.error());
    release(c.block.offset, c.block.size);
  }
  return {};
}

Result<std::vector<std::int32_t>> LogFile::values(std::uint32_t chunk, std::uint32_t part) const {
  const LogIndex& index = state_->index;
  assert(part != kStructurePart && index.blockCodec(chunk, part) != CodecId::kLifted);
  if (Status s = checkBlock(*this, chunk, part); !s) return std::unexpected(s.error());
  auto out = decodeValueBlock(block(chunk, part), index.components(part), index.tuples(chunk, part),
                              index.blockCodec(chunk, part));
  releaseBlock(*this, chunk, part);
  return out;
}

Result<ByteView> LogFile::checkedBlock(std::uint32_t chunk, std::uint32_t part) const {
  if (Status s = checkBlock(*this, chunk, part); !s) return std::unexpected(s.error());
  return block(chunk, part);
}

Result<ByteView> LogFile::closing(ClosingKind kind, std::uint32_t field) const {
  const ClosingBlock* c = state_->index.closingBlock(kind, field);
  if (c == nullptr)
    return fail(ErrorCode::kNotFound,
                "the log has no closing block of kind " + std::to_string(static_cast<int>(kind)));
  const ByteView view = bytes().subspan(static_cast<std::size_t>(c->block.offset), c->block.size);
  if (crc32c(view) != c->block.crc)
    return fail(ErrorCode::kBadChecksum,
                "closing block of kind " + std::to_string(static_cast<int>(kind)) +
                    ": the CRC-32C does not match; fetch the file again",
                c->block.offset);
  return view;
}

Status applyChunk(const LogFile& log, Refiner& refiner, std::uint32_t chunk,
                  std::span<const std::uint32_t> fields) {
  if (chunk >= log.index().chunks.size())
    return fail(ErrorCode::kNotFound, "there is no chunk " + std::to_string(chunk));
  if (Status s = checkBlock(log, chunk, kStructurePart); !s) return s;
  const auto positions = log.values(chunk, kPositionsPart);
  if (!positions) return std::unexpected(positions.error());
  if (Status s = refiner.apply(chunk, log.block(chunk, kStructurePart), *positions); !s) return s;
  releaseBlock(log, chunk, kStructurePart);
  for (const std::uint32_t f : fields)
    if (Status s = applyFieldBlock(log, refiner, chunk, f); !s) return s;
  return {};
}

Status applyFieldBlock(const LogFile& log, Refiner& refiner, std::uint32_t chunk,
                       std::uint32_t field) {
  if (chunk >= log.index().chunks.size())
    return fail(ErrorCode::kNotFound, "there is no chunk " + std::to_string(chunk));
  if (field >= log.index().fields.size())
    return fail(ErrorCode::kNotFound, "there is no field " + std::to_string(field));
  const std::uint32_t part = kFirstFieldPart + field;
  if (log.index().blockCodec(chunk, part) == CodecId::kLifted) {
    const Result<ByteView> bytes = log.checkedBlock(chunk, part);
    if (!bytes) return std::unexpected(bytes.error());
    const Status applied = refiner.applyField(field, chunk, *bytes);
    releaseBlock(log, chunk, part);
    return applied;
  }
  const auto values = log.values(chunk, part);
  if (!values) return std::unexpected(values.error());
  return refiner.applyField(field, chunk, *values);
}

LatticeMesh latticeMesh(const Manifest& manifest, const Refiner& refiner,
                        std::span<const std::uint32_t> fields) {
  LatticeMesh mesh;
  mesh.lattice = {manifest.latticeBits, manifest.latticeStep, manifest.latticeOrigin};
  mesh.points.assign(refiner.points().begin(), refiner.points().end());
  mesh.tetrahedra.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
  mesh.boundary.assign(refiner.boundary().begin(), refiner.boundary().end());
  for (const std::uint32_t f : fields) {
    mesh.fields.push_back(fieldInfoOf(manifest.fields[f]));
    if (const LabelNames* called = labelNamesOf(manifest, f))
      mesh.fields.back().labelNames = *called;
    mesh.values.emplace_back(refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
  }
  return mesh;
}

Status refineToLevel(const LogFile& log, Refiner& refiner, std::uint32_t level,
                     std::span<const std::uint32_t> fields, const std::stop_token& stop) {
  const std::uint32_t last = log.index().chunks.back().lastLevel;
  if (level > last)
    return fail(ErrorCode::kNotFound, "there is no level " + std::to_string(level) +
                                          "; the last is " + std::to_string(last));
  refiner.stopAtLevel(level);
  for (std::uint32_t chunk = 0;
       chunk < log.index().chunks.size() && (chunk == 0 || refiner.level() < level); ++chunk) {
    if (stop.stop_requested())
      return fail(ErrorCode::kIo, "stopped, because nobody waits for the level any more");
    if (Status s = applyChunk(log, refiner, chunk, fields); !s) return s;
  }
  return {};
}

Result<LatticeMesh> meshAtLevel(const LogFile& log, std::uint32_t level,
                                const std::optional<std::vector<std::uint32_t>>& fields,
                                const std::stop_token& stop) {
  const Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  std::vector<std::uint32_t> wanted;
  if (fields)
    wanted = *fields;
  else
    for (std::uint32_t f = 0; f < manifest->fields.size(); ++f) wanted.push_back(f);
  const std::vector<std::uint32_t> needed = withParents(log.fields(), wanted);

  Refiner refiner(log.index());
  if (Status s = refineToLevel(log, refiner, level, needed, stop); !s)
    return std::unexpected(s.error());
  return latticeMesh(*manifest, refiner, wanted);
}

}  // namespace qtet

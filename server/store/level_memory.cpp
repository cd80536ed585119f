#include "server/store/level_memory.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "codec/coding/number_type.h"
#include "codec/files/mesh_file.h"
#include "codec/log/decoding_memory.h"
#include "codec/log/log_index.h"
#include "server/store/series_maker.h"

namespace qtet {
namespace {

/// Digits, signs and separators of a number in text, at most and on average.
constexpr std::uint64_t kTextNumber = 26, kMeanTextNumber = 14;
/// The picture's samples, pixels and the encoder's room.
constexpr std::uint64_t kPictureBytes = 48u << 20;
/// Draco's tables of a boundary's triangle, and of one of its values; a plain copy is among them.
constexpr std::uint64_t kDracoTriangle = 600, kDracoValue = 48;
/// Copies of the mesh that the writers take: points and corners as integers, as coordinates, and as
/// the largest array of the file.
constexpr std::uint64_t kVertexCopies = 12 + 24 + 24, kCellCopies = 16 + 16 + 48,
                        kTriangleCopies = 2 * 12;

bool isText(LevelForm form) { return form == LevelForm::kUsda || form == LevelForm::kObj; }

bool needsWhole(LevelForm form) {
  return !isMeshFile(form) || needsLattice("." + std::string(formName(form)));
}

struct Sizes {
  explicit Sizes(const LevelRequest& request) {
    const Manifest& manifest = request.mesh->manifest;
    const ManifestLevel& level = manifest.levels[request.level];
    vertices = level.vertices, cells = level.tetrahedra, triangles = level.boundaryTriangles;
    const std::string ending = "." + std::string(formName(request.form));
    for (const std::uint32_t f : request.fields) {
      const ManifestField& field = manifest.fields[f];
      if (isMeshFile(request.form) && !holdsFields(ending, field.association)) continue;
      const std::uint64_t elements = field.association == "cell" ? cells : vertices,
                          count = elements * field.components;
      numbers += count;
      largest = std::max(largest, count);
      if (request.form == LevelForm::kMsh)
        // each tuple has its number, and is filled up to a tensor at most
        bytes += elements *
                 (4 + sizeof(double) * (field.components == 1   ? 1u
                                        : field.components <= 3 ? 3u
                                                                : std::max(9u, field.components)));
      else
        bytes +=
            count * (isText(request.form) ? kMeanTextNumber : numberType(field.type).sizeBytes);
      text += field.name.size() + kFieldText;
    }
  }

  /// A field's header in a file.
  static constexpr std::uint64_t kFieldText = 300;

  std::uint64_t vertices = 0, cells = 0, triangles = 0;
  std::uint64_t numbers = 0, largest = 0;  // of fields, and of one field
  std::uint64_t bytes = 0, text = 0;       // of the fields in the file
};

std::uint64_t seriesMemory(const LevelRequest& request) {
  const LogIndex& index = request.mesh->log.index();
  const auto with = [&](FieldsHeld held) {
    return decodingBytes(index, request.level, request.fields, held);
  };
  // All values are held if they are few.
  const std::uint64_t few =
      std::min(with(FieldsHeld::kAll), decodingBytes(index, request.level, {}, FieldsHeld::kAll) +
                                           3 * limits::kKeptValueBytes);
  const std::uint64_t instants = request.fields.size() * 64;
  return std::max(few, with(FieldsHeld::kOneByOne)) + instants;
}

/// The number in a file of a control group; "max" is none.
std::uint64_t limitIn(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::uint64_t out = 0;
  return in >> out ? out : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

std::uint64_t fileBytesOf(const LevelRequest& request) {
  const Sizes sizes(request);
  const std::uint64_t mesh = isText(request.form)
                                 ? (3 * sizes.vertices + 4 * sizes.cells) * kMeanTextNumber +
                                       6 * sizes.triangles * kMeanTextNumber
                                 : 28 * sizes.vertices + 40 * sizes.cells;
  return mesh + sizes.bytes + sizes.text;
}

std::uint64_t memoryOf(const LevelRequest& request) {
  if (request.point) return seriesMemory(request);
  const Sizes sizes(request);
  const bool whole = needsWhole(request.form);
  std::uint64_t out = decodingBytes(request.mesh->log.index(), request.level, request.fields,
                                    whole ? FieldsHeld::kAll : FieldsHeld::kOneByOne) +
                      sizes.vertices * kVertexCopies + sizes.cells * kCellCopies +
                      sizes.triangles * kTriangleCopies + 2 * sizes.text;
  if (whole)
    out += sizes.numbers * (sizeof(std::int32_t) + kDracoValue) + sizes.triangles * kDracoTriangle +
           (isMeshFile(request.form) ? 0 : kPictureBytes);
  else
    out += sizes.largest * (2 * sizeof(double) + (isText(request.form) ? 2 * kTextNumber : 8));
  if (isText(request.form))
    out += 2 * kTextNumber * (3 * sizes.vertices + 8 * sizes.cells + 12 * sizes.triangles);
  if (request.coding != ContentCoding::kIdentity) out += 3 * fileBytesOf(request);
  return out;
}

std::uint64_t ownMemory() {
  auto out = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
             static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  std::ifstream in("/proc/self/cgroup");
  std::string line;
  while (std::getline(in, line) && !line.starts_with("0::")) {
  }
  const std::filesystem::path root = "/sys/fs/cgroup";
  std::filesystem::path group = line.size() > 4 ? root / line.substr(4) : root;
  for (;; group = group.parent_path()) {
    out = std::min(out, limitIn(group / "memory.max"));
    if (group == root || group == group.root_path()) return out;
  }
}

}  // namespace qtet

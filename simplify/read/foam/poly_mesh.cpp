#include "simplify/read/foam/poly_mesh.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "simplify/mesh/split_mix64.h"
#include "simplify/read/foam/foam_list.h"
#include "simplify/read/options/time_text.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Label = FoamList::Label;

/// A number that looks random for each pair of points.
std::uint64_t hashOf(Label a, Label b) {
  return SplitMix64(static_cast<std::uint64_t>(a) << 32 ^ static_cast<std::uint64_t>(b)).next();
}

/// Sums up the directed edges of a face. An edge and its reverse give 0 together. So the sum over
/// the faces of a closed cell is 0. That of an open cell is 0 by a chance of 2^-64.
std::uint64_t edgesOf(std::span<const Label> corners) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Label a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
    if (a != b) sum += a < b ? hashOf(a, b) : std::uint64_t{0} - hashOf(b, a);
  }
  return sum;
}

/// Checks one folder, and returns its number of cells.
Result<std::uint64_t> checkPolyMesh(const fs::path& folder, std::chrono::seconds patience) {
  Result<FoamList> points = FoamList::open(folder / "points", patience);
  if (!points && FoamList::isThere(folder / "points")) return std::unexpected(points.error());
  Label pointCount = INT64_MAX;  // those of another time, if there are none here
  if (points) {
    const auto told = points->size();
    if (!told) return std::unexpected(told.error());
    pointCount = static_cast<Label>(*told);
  }
  Result<FoamList> facesFile = FoamList::open(folder / "faces", patience);
  if (!facesFile) return std::unexpected(facesFile.error());
  const auto faceCount = facesFile->faceCount();
  if (!faceCount) return std::unexpected(faceCount.error());
  Result<FoamList> ownerFile = FoamList::open(folder / "owner", patience);
  if (!ownerFile) return std::unexpected(ownerFile.error());
  const auto owner = ownerFile->labels(*faceCount);
  if (!owner) return std::unexpected(owner.error());
  Result<FoamList> neighbourFile = FoamList::open(folder / "neighbour", patience);
  if (!neighbourFile) return std::unexpected(neighbourFile.error());
  const auto neighbour = neighbourFile->labels(*faceCount);
  if (!neighbour) return std::unexpected(neighbour.error());

  Label last = -1;
  for (const Label cell : *owner) last = std::max(last, cell);
  for (const Label cell : *neighbour) last = std::max(last, cell);
  if (std::cmp_greater_equal(last, owner->size()))
    return ownerFile->bad("a cell has number " + std::to_string(last) + ", but there are only " +
                          std::to_string(owner->size()) + " faces");
  std::vector<std::uint64_t> open(static_cast<std::size_t>(last + 1));

  std::size_t face = 0, inner = 0;
  const Status done = facesFile->faces([&](std::span<const Label> corners) -> Status {
    if (face >= owner->size()) return ownerFile->bad("it has fewer lines than there are faces");
    for (const Label v : corners)
      if (v < 0 || v >= pointCount)
        return facesFile->badHere("face " + std::to_string(face) + " has a corner " +
                                  std::to_string(v) + " that is none of the " +
                                  std::to_string(pointCount) + " points");
    if ((*owner)[face] < 0) return ownerFile->bad("face " + std::to_string(face) + " has no cell");
    const std::uint64_t edges = edgesOf(corners);
    open[static_cast<std::size_t>((*owner)[face])] += edges;
    const bool isInner = face < neighbour->size() && (*neighbour)[face] >= 0;
    if (isInner) open[static_cast<std::size_t>((*neighbour)[face])] -= edges;
    inner += isInner ? 1 : 0;
    ++face;
    return {};
  });
  if (!done) return std::unexpected(done.error());
  if (face != owner->size() || neighbour->size() > face)
    return facesFile->bad("it has " + std::to_string(face) + " faces, but owner has " +
                          std::to_string(owner->size()) + " lines and neighbour " +
                          std::to_string(neighbour->size()));
  const auto isOpen = [](std::uint64_t sum) { return sum != 0; };
  if (const auto torn = std::ranges::find_if(open, isOpen); torn != open.end())
    return facesFile->bad("the faces of " + std::to_string(std::ranges::count_if(open, isOpen)) +
                          " cells do not close, first those of cell " +
                          std::to_string(torn - open.begin()) +
                          ": lines of faces, owner or neighbour are wrong");

  Result<FoamList> boundary = FoamList::open(folder / "boundary", patience);
  if (!boundary) return std::unexpected(boundary.error());
  const auto outer = boundary->patchFaces();
  if (!outer) return std::unexpected(outer.error());
  if (*outer != face - inner)
    return boundary->bad("its patches have " + std::to_string(*outer) +
                         " faces, but the mesh has " + std::to_string(face - inner) +
                         " at its boundary");
  return open.size();
}

/// The meshes in a folder of the case and in the folders of its regions. A folder polyMesh that has
/// points alone says where a mesh has moved.
void addMeshes(const fs::path& folder, std::vector<fs::path>& out) {
  const auto add = [&](const fs::path& at) {
    const auto has = [&](const char* name) { return FoamList::isThere(at / "polyMesh" / name); };
    if (has("faces") || has("owner") || has("neighbour")) out.push_back(at / "polyMesh");
  };
  add(folder);
  std::error_code code;
  for (const fs::directory_entry& region : fs::directory_iterator(folder, code))
    if (region.is_directory(code)) add(region.path());
}

}  // namespace

Result<std::optional<std::uint64_t>> checkPolyMeshes(const fs::path& folder,
                                                     std::chrono::seconds patience) {
  std::vector<fs::path> meshes;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    if ((name == "constant" || plainTime(name)) && entry.is_directory(code))
      addMeshes(entry.path(), meshes);
  }
  if (meshes.empty())
    return fail(ErrorCode::kNotFound,
                folder.string() +
                    " has no mesh: its constant/polyMesh is missing; copy the case "
                    "whole");
  std::ranges::sort(meshes);  // of several faults always the same one is reported
  std::uint64_t cells = 0;
  for (const fs::path& mesh : meshes) {
    const Result<std::uint64_t> found = checkPolyMesh(mesh, patience);
    if (!found) return std::unexpected(found.error());
    cells = *found;
  }
  if (meshes.size() != 1) return std::nullopt;
  return cells;
}

}  // namespace qtet

#include "simplify/clean/verify.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>

#include "simplify/mesh/split_mix64.h"

namespace qtet {
namespace {

/// Rounds over the cells: enough to tell apart coincident twins, whose neighbourhoods differ within
/// one or two.
constexpr int kRounds = 3;

struct Hash {
  std::uint64_t high = 0, low = 0;

  auto operator<=>(const Hash&) const = default;
  Hash& operator+=(const Hash& other) {
    high += other.high;
    low += other.low;
    return *this;
  }
};

/// The hash of a sequence, one element after the other; the two halves mix with different
/// constants.
class Hasher {
 public:
  Hasher& add(std::uint64_t value) {
    hash_.high = mixed(hash_.high * 0x9e3779b97f4a7c15u + value + 0x632be59bd9b4e019u);
    hash_.low = mixed((hash_.low ^ (value * 0xd6e8feb86659fd93u)) + 0xa0761d6478bd642fu);
    return *this;
  }
  Hasher& add(const Hash& hash) { return add(hash.high).add(hash.low); }
  [[nodiscard]] Hash take() const { return hash_; }

 private:
  Hash hash_{0x243f6a8885a308d3u, 0x13198a2e03707344u};
};

/// Adds the values of a point or, of the cell fields, of a tetrahedron.
void addValues(const LatticeMesh& mesh, bool ofCells, std::size_t i, Hasher& hasher) {
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    if (isCellField(mesh.fields[f]) != ofCells) continue;
    const std::size_t components = mesh.fields[f].components;
    for (std::size_t c = 0; c < components; ++c)
      hasher.add(static_cast<std::uint32_t>(mesh.values[f][i * components + c]));
  }
}

/// The hash of a vertex' own place and values.
Hash ownHash(const LatticeMesh& mesh, std::size_t v) {
  Hasher hasher;
  for (const std::int32_t x : mesh.points[v]) hasher.add(static_cast<std::uint32_t>(x));
  addValues(mesh, false, v, hasher);
  return hasher.take();
}

std::vector<Hash> ownHashes(const LatticeMesh& mesh) {
  std::vector<Hash> out(mesh.points.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = ownHash(mesh, v);
  return out;
}

/// The face opposite each corner as that corner sees it: the same rotation for all corners of a
/// positive cell.
constexpr std::array<std::array<std::size_t, 3>, 4> kSeenFrom{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The hash of three colours in their rotation, wherever it starts.
Hash rotationHash(Hash a, Hash b, Hash c) {
  const auto smallest = std::min({std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}});
  return Hasher().add(smallest[0]).add(smallest[1]).add(smallest[2]).take();
}

/// Every vertex's colour with what its cells show of their other vertices and of their values.
std::vector<Hash> refined(const LatticeMesh& mesh, const std::vector<Hash>& colours) {
  assert(colours.size() == mesh.points.size());
  std::vector<Hash> sums(colours.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& cell = mesh.tetrahedra[t];
    for (std::size_t i = 0; i < 4; ++i) {
      Hasher hasher;
      hasher.add(rotationHash(colours[cell[kSeenFrom[i][0]]], colours[cell[kSeenFrom[i][1]]],
                              colours[cell[kSeenFrom[i][2]]]));
      addValues(mesh, true, t, hasher);
      sums[cell[i]] += hasher.take();
    }
  }
  std::vector<Hash> out(colours.size());
  for (std::size_t v = 0; v < out.size(); ++v)
    out[v] = Hasher().add(colours[v]).add(sums[v]).take();
  return out;
}

/// A cell's hash: its colours in ascending order and its parity. Equal colours make both parities
/// the same cell.
Hash cellHash(const Tetrahedron& cell, const std::vector<Hash>& colours) {
  std::array<Hash, 4> c{colours[cell[0]], colours[cell[1]], colours[cell[2]], colours[cell[3]]};
  std::uint64_t odd = 0;
  for (std::size_t end = 3; end > 0; --end) {
    for (std::size_t i = 0; i < end; ++i) {
      if (!(c[i + 1] < c[i])) continue;
      std::swap(c[i], c[i + 1]);
      odd ^= 1;
    }
  }
  if (c[0] == c[1] || c[1] == c[2] || c[2] == c[3]) odd = 2;
  return Hasher().add(c[0]).add(c[1]).add(c[2]).add(c[3]).add(odd).take();
}

std::vector<Hash> cellHashes(const LatticeMesh& mesh, const std::vector<Hash>& colours) {
  std::vector<Hash> out;
  out.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& cell : mesh.tetrahedra) out.push_back(cellHash(cell, colours));
  return out;
}

/// `hashes`, each with its cell's values.
std::vector<Hash> withValues(const LatticeMesh& mesh, const std::vector<Hash>& hashes) {
  assert(hashes.size() == mesh.tetrahedra.size());
  std::vector<Hash> out;
  out.reserve(hashes.size());
  for (std::size_t t = 0; t < hashes.size(); ++t) {
    Hasher hasher;
    hasher.add(hashes[t]);
    addValues(mesh, true, t, hasher);
    out.push_back(hasher.take());
  }
  return out;
}

/// The first element of `mine` that occurs more often there than in `theirs`.
std::optional<std::size_t> firstSurplus(const std::vector<Hash>& mine,
                                        const std::vector<Hash>& theirs) {
  std::vector<Hash> a = mine, b = theirs;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  if (a == b) return std::nullopt;
  std::vector<Hash> surplus;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(surplus));
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (std::binary_search(surplus.begin(), surplus.end(), mine[i])) return i;
  }
  return std::nullopt;
}

std::string describe(const LatticeMesh& mesh, std::size_t v) {
  const LatticePoint& p = mesh.points[v];
  return "vertex " + std::to_string(v) + " at lattice point (" + std::to_string(p[0]) + ", " +
         std::to_string(p[1]) + ", " + std::to_string(p[2]) + ")";
}

std::string describeCell(const LatticeMesh& mesh, std::size_t cell) {
  std::string vertices;
  for (const VertexId v : mesh.tetrahedra[cell])
    vertices += (vertices.empty() ? "" : ", ") + describe(mesh, v);
  return "cell " + std::to_string(cell) + " of " + vertices;
}

std::unexpected<Error> different(const std::string& what) {
  return fail(ErrorCode::kBadValue, what +
                                        "; the log does not hold this mesh: build it again from "
                                        "the input, and report it if it stays so");
}

Status sameShape(const LatticeMesh& decoded, const LatticeMesh& expected) {
  const auto counts = [](const LatticeMesh& mesh) {
    return std::to_string(mesh.points.size()) + " vertices, " +
           std::to_string(mesh.tetrahedra.size()) + " tetrahedra and " +
           std::to_string(mesh.fields.size()) + " fields";
  };
  if (decoded.points.size() != expected.points.size() ||
      decoded.tetrahedra.size() != expected.tetrahedra.size() ||
      decoded.fields.size() != expected.fields.size()) {
    return different("decoded are " + counts(decoded) + ", expected " + counts(expected));
  }
  for (std::size_t f = 0; f < decoded.fields.size(); ++f) {
    const auto shape = [f](const LatticeMesh& mesh) {
      const FieldInfo& field = mesh.fields[f];
      return field.name + " with " + std::to_string(field.components) + " components a " +
             field.association;
    };
    if (shape(decoded) != shape(expected))
      return different("field " + std::to_string(f) + " is " + shape(decoded) + ", expected " +
                       shape(expected));
  }
  return {};
}

std::uint64_t repeats(std::vector<Hash> colours) {
  std::sort(colours.begin(), colours.end());
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const bool twin = (i > 0 && colours[i - 1] == colours[i]) ||
                      (i + 1 < colours.size() && colours[i + 1] == colours[i]);
    count += twin;
  }
  return count;
}

}  // namespace

Result<VerifyReport> sameMesh(const LatticeMesh& decoded, const LatticeMesh& expected) {
  if (Status shape = sameShape(decoded, expected); !shape) return std::unexpected(shape.error());
  std::vector<Hash> mine = ownHashes(decoded), theirs = ownHashes(expected);
  if (const auto v = firstSurplus(mine, theirs))
    return different(describe(decoded, *v) + " with its field values is not expected");

  // Cells by what their vertices carry first: that names the cell at fault, which later rounds
  // spread to its surroundings.
  const auto compareCells = [&]() -> Status {
    const std::vector<Hash> mineCells = cellHashes(decoded, mine),
                            theirCells = cellHashes(expected, theirs);
    if (const auto cell = firstSurplus(mineCells, theirCells))
      return different(describeCell(decoded, *cell) +
                       " is not expected, or not in this orientation");
    if (const auto cell =
            firstSurplus(withValues(decoded, mineCells), withValues(expected, theirCells)))
      return different(describeCell(decoded, *cell) + " with its field values is not expected");
    return {};
  };
  if (Status same = compareCells(); !same) return std::unexpected(same.error());
  for (int round = 0; round < kRounds; ++round) {
    mine = refined(decoded, mine);
    theirs = refined(expected, theirs);
  }
  if (const auto v = firstSurplus(mine, theirs))
    return different(describe(decoded, *v) + " has other cells round it than expected");
  if (Status same = compareCells(); !same) return std::unexpected(same.error());
  return VerifyReport{decoded.points.size(), decoded.tetrahedra.size(), repeats(mine)};
}

}  // namespace qtet

#include "simplify/blocks/original_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "codec/mesh/boundary.h"
#include "codec/mesh/predicates.h"
#include "simplify/blocks/block_fusion.h"
#include "simplify/blocks/sampled_part.h"
#include "simplify/cost/boundary_weight.h"
#include "simplify/cost/expected_error.h"
#include "simplify/measure/measure_samples.h"

namespace qtet {
namespace {

/// Vertices that speak for all where the cost finds its directions: some 100 MB with 512
/// components.
constexpr std::uint64_t kBasisVertices = 50'000;

/// The least and the largest integer of a component.
struct IntegerRange {
  std::int32_t low = std::numeric_limits<std::int32_t>::max();
  std::int32_t high = std::numeric_limits<std::int32_t>::min();

  void include(std::int32_t value) { low = std::min(low, value), high = std::max(high, value); }
};

/// The piece as a mesh, without its vertices' names.
LatticeMesh meshOf(MeshPiece& piece, const LatticePieces& whole) {
  LatticeMesh out;
  out.lattice = whole.lattice();
  out.fields = whole.fields();
  out.points = std::move(piece.points);
  out.tetrahedra = std::move(piece.tetrahedra);
  out.values = std::move(piece.values);
  for (const PieceTriangle& t : piece.boundary) out.boundary.push_back(t.corners);
  return out;
}

}  // namespace

/// One look at all pieces.
class OriginalFigures::Look {
 public:
  explicit Look(OriginalFigures& out)
      : out_(out),
        whole_(*out.pieces_),
        faces_(whole_.fields()),
        edges_(whole_.fields()),
        vertices_(whole_.fields()),
        integers_(whole_.fields().size()) {
    out_.faceStep_ = faceStep(whole_.tetrahedra());
    out_.edgeStep_ = edgeStep(whole_.triangles());
    middleStep_ = whole_.tetrahedra() / kSampledMiddles + 1;
    vertexStep_ = whole_.vertices() / kBasisVertices + 1;
    std::size_t components = 0;
    for (std::size_t f = 0; f < integers_.size(); ++f) {
      integers_[f].resize(whole_.fields()[f].components);
      if (!isCellField(whole_.fields()[f])) components += integers_[f].size();
    }
    needsBasis_ = components > kMaxCostComponents;
  }

  void take(GivenPiece&& given) {
    const LatticeMesh mesh = meshOf(given.piece, whole_);
    const std::vector<WholeVertex>& names = given.piece.vertices;
    out_.labels_.add(mesh);
    takeIntegers(mesh);
    for (const LatticePoint& p : mesh.points)
      for (std::size_t a = 0; a < 3; ++a) box_[a].include(p[a]);
    for (const Tetrahedron& cell : mesh.tetrahedra) {
      out_.cellMeasure_ += placesMeasure(cornersOf<4>(mesh.points, cell));
      if (cells_++ % middleStep_ == 0) out_.middles_.push_back(middleOf(mesh.points, cell));
      takeFaces(mesh, names, cell);
    }
    for (const Triangle& t : mesh.boundary) {
      out_.surfaceMeasure_ += placesMeasure(cornersOf<3>(mesh.points, t));
      volume_ += qtet::volume6({0, 0, 0}, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
      for (std::size_t i = 0; i < 3; ++i)
        if (isSampledEdge(mesh, t[i], t[(i + 1) % 3], out_.edgeStep_)) {
          edges_.addTriangle(mesh, names, t);
          break;
        }
    }
    for (VertexId v = 0; needsBasis_ && v < names.size(); ++v)
      if (names[v] % vertexStep_ == 0) vertices_.addVertex(mesh, names, v);
  }

  void end() {
    out_.volume6_ = static_cast<double>(volume_);
    out_.faceCells_ = faces_.take(whole_.lattice());
    out_.edgeCells_ = edges_.take(whole_.lattice());
    out_.vertices_ = vertices_.take(whole_.lattice());
    double squared = 0;
    for (const IntegerRange& side : box_) {
      const double length = static_cast<double>(side.high) - side.low;
      squared += length * length;
    }
    out_.diagonal_ = std::max(1.0, std::sqrt(squared));
    for (const std::vector<IntegerRange>& field : integers_) {
      double range = 0;
      IntegerRange all;
      for (const IntegerRange& component : field) {
        const double own = static_cast<double>(component.high) - component.low;
        range += own * own;
        all.include(component.low), all.include(component.high);
      }
      out_.ranges_.push_back(std::sqrt(range));
      out_.isOneValue_.push_back(all.low == all.high);
    }
  }

 private:
  void takeIntegers(const LatticeMesh& mesh) {
    for (std::size_t f = 0; f < integers_.size(); ++f) {
      const std::size_t n = integers_[f].size();
      for (std::size_t i = 0; i < mesh.values[f].size(); ++i)
        integers_[f][i % n].include(mesh.values[f][i]);
    }
  }

  void takeFaces(const LatticeMesh& mesh, std::span<const WholeVertex> names,
                 const Tetrahedron& cell) {
    for (int corner = 0; corner < 4; ++corner)
      if (isSampledFace(mesh, cellFace(cell, corner), out_.faceStep_)) {
        faces_.addCell(mesh, names, cell);
        return;
      }
  }

  OriginalFigures& out_;
  const LatticePieces& whole_;
  SampledPart faces_, edges_, vertices_;
  std::vector<std::vector<IntegerRange>> integers_;  // by field and component
  std::array<IntegerRange, 3> box_;
  std::uint64_t cells_ = 0, middleStep_ = 1, vertexStep_ = 1;
  bool needsBasis_ = false;
  Int128 volume_ = 0;
};

Result<OriginalFigures> OriginalFigures::of(LatticePieces& pieces) {
  OriginalFigures out(pieces);
  Look look(out);
  const Status looked = pieces.forEach([&](GivenPiece&& piece) -> Status {
    look.take(std::move(piece));
    return {};
  });
  if (!looked) return std::unexpected(looked.error());
  look.end();
  return out;
}

double OriginalFigures::wallThickness() const {
  return surfaceMeasure_ > 0 ? 2 * std::abs(volume6_) / 6 / (surfaceMeasure_ / 2) / diagonal_ : 0;
}

std::vector<double> OriginalFigures::fieldErrors(std::span<const CostPart> parts) const {
  return expectedFieldErrors(faceCells_, parts, faceStep_);
}

Result<double> OriginalFigures::boundaryWeight(std::span<const CostPart> parts,
                                               std::span<const double> errors) const {
  BoundarySums sums;
  const Status looked = pieces_->forEach([&](GivenPiece&& given) -> Status {
    sums.add(meshOf(given.piece, *pieces_), parts);
    return {};
  });
  if (!looked) return std::unexpected(looked.error());
  return balancedBoundaryWeight(sums, diagonal_, expectedBoundaryError(edgeCells_, edgeStep_),
                                errors);
}

Result<CostFrame> OriginalFigures::costFrame(const CostOptions& options) const {
  const std::vector<CostPart> parts = costPartsOf(fields(), isOneValue_, options.fieldWeights);
  CostOptions full = options;
  if (!full.boundaryWeight) {
    const Result<double> weight = parts.empty() ? 0 : boundaryWeight(parts, fieldErrors(parts));
    if (!weight) return std::unexpected(weight.error());
    full.boundaryWeight = *weight;
  }
  return CostFrame(fields(), parts, CostBasis(vertices_, parts), pieces_->lattice().bits, diagonal_,
                   full);
}

}  // namespace qtet

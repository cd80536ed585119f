#include "simplify/blocks/original_sampler.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "simplify/measure/field_replay.h"

namespace qtet {
namespace {

constexpr std::uint64_t kFieldSeed = 0x5EEDF1E1D5u;  // other numbers than the surface's

}  // namespace

OriginalSampler::OriginalSampler(const LatticePieces& whole, const OriginalFigures& figures,
                                 const SamplerOptions& options)
    : whole_(whole),
      volume_(figures.cellMeasure(), options.counts.volume, options.seed ^ kFieldSeed),
      surface_(figures.surfaceMeasure(), options.surface, options.seed),
      uniform_(figures.cellMeasure() > 0 ? options.counts.volume : 0),
      vertexStep_(options.counts.vertices > 0 ? whole.vertices() / options.counts.vertices + 1
                                              : 0) {
  const std::size_t fields = whole.fields().size();
  out_.truth.resize(fields), vertexTruth_.resize(fields);
  out_.ranges = figures.ranges();
  out_.volume6 = figures.volume6();
  out_.diagonal = figures.diagonal();
}

void OriginalSampler::take(GivenPiece& given) {
  MeshPiece& piece = given.piece;
  std::optional<CellId> last;  // with a volume
  for (CellId c = 0; c < piece.tetrahedra.size(); ++c) {
    const double measure = placesMeasure(cornersOf<4>(piece.points, piece.tetrahedra[c]));
    if (measure > 0) last = c;
    volume_.enter(measure);
    while (volume_.hasPlace()) drawIn(piece, c);
  }
  // what rounding left behind the end
  while (given.isLast && last && uniform_ > 0 && volume_.isWanting()) drawIn(piece, *last);
  for (const PieceTriangle& t : piece.boundary) {
    const std::array<Vector3, 3> corners = cornersOf<3>(piece.points, t.corners);
    surface_.enter(placesMeasure(corners));
    while (surface_.hasPlace()) {
      const std::array<double, 4> weights = surface_.takeInTriangle();
      out_.surface.push_back(blend(corners, std::array{weights[0], weights[1], weights[2]}));
    }
  }
  drawVertices(given);
}

void OriginalSampler::drawIn(MeshPiece& piece, CellId cell) {
  const std::array<double, 4> weights = volume_.takeInTetrahedron();
  piece.places.push_back({static_cast<std::uint32_t>(out_.places.size()), cell});
  out_.places.push_back({blend(cornersOf<4>(piece.points, piece.tetrahedra[cell]), weights), cell});
  addTruth(piece, cell, weights, out_.truth);
}

/// Every so-many-th vertex, in the first cell of the first piece that has it.
void OriginalSampler::drawVertices(GivenPiece& given) {
  MeshPiece& piece = given.piece;
  if (vertexStep_ == 0) return;
  std::vector<std::uint8_t> isWanted(piece.vertices.size());
  for (VertexId v = 0; v < isWanted.size(); ++v) {
    const WholeVertex whole = piece.vertices[v];
    if (whole % vertexStep_ != 0) continue;
    isWanted[v] = !std::ranges::binary_search(given.shared, whole) || taken_.insert(whole).second;
  }
  for (CellId c = 0; c < piece.tetrahedra.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = piece.tetrahedra[c][i];
      if (!isWanted[v]) continue;
      isWanted[v] = 0;
      std::array<double, 4> weights{};
      weights[i] = 1;
      piece.places.push_back({uniform_ + static_cast<std::uint32_t>(vertices_.size()), c});
      vertices_.push_back({toVector(piece.points[v]), c});
      addTruth(piece, c, weights, vertexTruth_);
    }
}

void OriginalSampler::addTruth(const MeshPiece& piece, CellId cell,
                               const std::array<double, 4>& weights,
                               std::vector<std::vector<double>>& truth) {
  for (std::size_t f = 0; f < truth.size(); ++f) {
    const std::size_t n = whole_.fields()[f].components;
    for (std::size_t c = 0; c < n; ++c)
      truth[f].push_back(isCellField(whole_.fields()[f])
                             ? piece.values[f][cell * n + c]
                             : valueIn(piece.tetrahedra[cell], weights, piece.values[f], n, c));
  }
}

OriginalSamples OriginalSampler::samples() {
  out_.uniform = out_.places.size();
  out_.places.insert(out_.places.end(), vertices_.begin(), vertices_.end());
  for (std::size_t f = 0; f < vertexTruth_.size(); ++f)
    out_.truth[f].insert(out_.truth[f].end(), vertexTruth_[f].begin(), vertexTruth_[f].end());
  return std::move(out_);
}

}  // namespace qtet

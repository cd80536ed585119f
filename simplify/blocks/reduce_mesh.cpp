#include "simplify/blocks/reduce_mesh.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "codec/mesh/boundary.h"
#include "simplify/blocks/block_fusion.h"
#include "simplify/blocks/original_sampler.h"
#include "simplify/blocks/shared_vertices.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/workers.h"
#include "simplify/parts/band_price.h"

namespace qtet {
namespace {

/// A band ends at the price at which one in so many cells is left. Blocks have fewer seams than
/// parts (kBandFactor). With 2.5 the last level of fin has 1.18 times the error of one piece, with
/// 2 it has 1.07 times that.
constexpr double kBlockFactor = 2;
/// The price of a band is found in one part of so many, of so many cells each. It takes many: what
/// is cheap differs from place to place.
constexpr std::uint32_t kSampledOneIn = 8;
constexpr std::size_t kPartCells = 32'000;
/// The last band aims at this share of the wanted cells, since its price comes from a sample.
constexpr double kAim = 0.97;
/// A band that removes less than this fraction of the cells was in vain. The next one has blocks of
/// twice as many cells and goes on at any price, up to blocks of so many.
constexpr double kWorthABand = 0.02;
constexpr std::size_t kMostBlockCells = 4 * kBlockCells;
/// More bands have no numbers for their vertices (newVertex). A mesh of 2^53 cells takes 50.
constexpr std::uint32_t kMostBands = 120;
/// The share of what is left of the envelope's tolerance that a band may take. It takes no more
/// than its boundary moves at most, which mostly is far less.
constexpr double kToleranceShare = 0.8;

template <class T>
T orThrow(Result<T>&& result) {
  if (!result) throw BlockFailed{result.error()};
  return std::move(*result);
}
void throwIfFailed(const Status& status) {
  if (!status) throw BlockFailed{status.error()};
}

/// The blocks of a band, and what waits for them.
struct Band {
  std::uint32_t number = 0;
  std::unique_ptr<PieceStore> store;
  std::uint32_t blocks = 0;
  std::vector<std::vector<WholeVertex>> shared;  // by block
  std::vector<LatticeBox> boxes;                 // by block
  std::size_t cells = 0;
};

LatticeBox emptyBox() {
  LatticeBox out;
  out.low.fill(std::numeric_limits<std::int32_t>::max());
  out.high.fill(std::numeric_limits<std::int32_t>::min());
  return out;
}

class Reduction {
 public:
  Reduction(BlockFrame frame, const ReduceOptions& options, std::size_t cells, int threads)
      : frame_(std::move(frame)),
        options_(options),
        workers_(threads, frame_.options.stop),
        all_(cells),
        blockCells_(options.blockCells),
        tolerance_(frame_.options.envelopeTolerance.value_or(kEnvelopeTolerance)) {
    frame_.options.progress = {};
  }

  /// Deals the pieces of the whole mesh to the blocks of the first band.
  void begin(std::vector<CellMiddle> middles, LatticePieces& original, OriginalSampler& sampler) {
    beginBand(0, all_, std::move(middles));
    throwIfFailed(original.forEach([&](GivenPiece&& given) -> Status {
      sampler.take(given);
      dealTo(given.piece, given.number, given.shared);
      return {};
    }));
    endDeal();
  }

  /// Bands until few enough cells are left.
  void run() {
    while (band_.cells > options_.cells) {
      if (bands_ == kMostBands) refuse(band_.cells);
      runBand();
      ++bands_;
      report(band_.cells);
    }
  }

  /// The mesh that is left.
  MeshPiece take() {
    std::vector<MeshPiece> pieces;
    for (std::uint32_t b = 0; b < band_.blocks; ++b) pieces.push_back(blockOf(b).piece);
    band_.store.reset();
    return joined(pieces, frame_.shape);
  }

  [[nodiscard]] std::uint32_t bands() const { return bands_; }
  /// The envelope's tolerance less the most that a place may be outside the original by now.
  [[nodiscard]] double toleranceLeft() const { return tolerance_; }
  [[nodiscard]] const OneSidedDistance& toMesh() const { return toMesh_; }
  [[nodiscard]] const OneSidedDistance& toOriginal() const { return toOriginal_; }

 private:
  [[nodiscard]] std::unique_ptr<PieceStore> newStore() const {
    if (!options_.spool) return std::make_unique<PieceStore>(std::make_unique<MemorySpool>());
    return std::make_unique<PieceStore>(orThrow(options_.spool()));
  }

  void beginBand(std::uint32_t number, std::size_t cells, std::vector<CellMiddle> middles) {
    const auto wanted = static_cast<std::uint32_t>((cells + blockCells_ - 1) / blockCells_);
    planes_.emplace(std::move(middles), wanted > 1 ? wanted + number % 2 : 1);
    band_ = {};
    band_.number = number;
    band_.cells = cells;
    band_.blocks = planes_->count();
    band_.store = newStore();
    band_.boxes.assign(band_.blocks, emptyBox());
  }

  /// `own`: the vertices of the piece that were in several blocks before.
  void dealTo(const MeshPiece& piece, std::uint32_t from, std::span<const WholeVertex> own) {
    std::vector<std::uint32_t> blockOf(piece.tetrahedra.size());
    for (CellId c = 0; c < blockOf.size(); ++c) blockOf[c] = planes_->blockOf(middleOf(piece, c));
    std::vector<std::pair<std::uint32_t, std::vector<WholeVertex>>> given;
    std::vector<WholeVertex> mayBe =
        orThrow(deal(piece, frame_.shape, blockOf, band_.blocks,
                     [&](std::uint32_t block, MeshPiece&& to) -> Status {
                       growBox(block, to);
                       given.emplace_back(block, to.vertices);
                       return band_.store->put(block, from, to);
                     }));
    mayBe.insert(mayBe.end(), own.begin(), own.end());
    std::ranges::sort(mayBe);
    for (const auto& [block, vertices] : given) shared_.add(block, vertices, mayBe);
    workers_.throwIfStopped();
  }

  void growBox(std::uint32_t block, const MeshPiece& piece) {
    const std::lock_guard lock(mutex_);
    LatticeBox& box = band_.boxes[block];
    for (const LatticePoint& p : piece.points)
      for (std::size_t i = 0; i < 3; ++i)
        box.low[i] = std::min(box.low[i], p[i]), box.high[i] = std::max(box.high[i], p[i]);
  }

  void endDeal() { band_.shared = shared_.take(band_.blocks); }

  [[nodiscard]] Block blockOf(std::uint32_t b) const {
    Block out;
    out.band = band_.number, out.number = b;
    out.isWhole = band_.blocks == 1;
    const std::vector<MeshPiece> pieces = orThrow(band_.store->get(b));
    out.piece = joined(pieces, frame_.shape);
    out.shared = band_.shared[b];
    return out;
  }
  /// The boxes of other blocks that a fusion of block `b` may reach.
  [[nodiscard]] std::vector<LatticeBox> othersOf(std::uint32_t b) const {
    LatticeBox own = band_.boxes[b];
    const double tolerance = frame_.options.envelopeTolerance.value_or(0);
    const auto reach =
        static_cast<std::int32_t>(std::ceil(tolerance * frame_.samples->diagonal)) + 1;
    for (std::size_t i = 0; i < 3; ++i) own.low[i] -= reach, own.high[i] += reach;
    std::vector<LatticeBox> out;
    for (std::uint32_t other = 0; other < band_.blocks; ++other)
      if (other != b && meet(own, band_.boxes[other])) out.push_back(band_.boxes[other]);
    return out;
  }

  void runBand() {
    frame_.options.envelopeTolerance = kToleranceShare * toleranceLeft();
    // one block ends at the wanted cells exactly
    const bool isWhole = band_.blocks == 1;
    const double goal = (isWhole ? 1 : kAim) * static_cast<double>(options_.cells) /
                        static_cast<double>(band_.cells);
    const float key = isWhole || isStuck_ ? std::numeric_limits<float>::infinity()
                                          : price(std::max(goal, 1 / kBlockFactor), goal);
    // fused pieces wait in a store of their own until the planes of the next band are known
    const std::unique_ptr<PieceStore> fused = newStore();
    std::vector<std::vector<CellMiddle>> middles(band_.blocks);
    std::vector<BoundaryMove> moved(band_.blocks);
    std::vector<std::size_t> left(band_.blocks, 0);
    std::atomic<std::size_t> gone{0};
    const std::size_t step = band_.cells / kSampledMiddles + 1;
    workers_.forEach(band_.blocks, 1, [&](std::size_t worker, std::size_t i) {
      const auto b = static_cast<std::uint32_t>(i);
      Block block = blockOf(b);
      const std::size_t before = block.piece.tetrahedra.size();
      const std::vector<LatticeBox> others = othersOf(b);
      block.others = others;
      const PartEnd end{
          .key = key, .cells = share(goal, block.piece.tetrahedra.size()), .leastShare = 0};
      if (block.piece.tetrahedra.empty()) return;
      const FusedBlock out = fuseBlock(std::move(block), frame_, end);
      for (std::size_t c = 0; c < out.piece.tetrahedra.size(); c += step)
        middles[b].push_back(middleOf(out.piece, static_cast<CellId>(c)));
      moved[b] = out.moved;
      left[b] = out.piece.tetrahedra.size();
      throwIfFailed(fused->put(b, 0, out.piece));
      gone += before - left[b];
      if (worker == 0) report(band_.cells - gone);
    });
    addMoves(moved);
    const std::size_t cells = std::accumulate(left.begin(), left.end(), std::size_t{0});
    judge(cells);
    dealAnew(*fused, std::move(middles), cells);
  }

  /// Decides how the next band begins if this one was in vain.
  void judge(std::size_t left) {
    const auto removed = static_cast<double>(band_.cells - left);
    isStuck_ = removed < kWorthABand * static_cast<double>(band_.cells);
    if (!isStuck_) return;
    if (left > options_.cells && (band_.blocks == 1 || blockCells_ >= kMostBlockCells))
      refuse(left);
    blockCells_ *= 2;
  }

  [[noreturn]] void refuse(std::size_t left) const {
    throw BlockFailed{{ErrorCode::kLimitExceeded,
                       "the mesh cannot be reduced to " + std::to_string(options_.cells) +
                           " cells: no fusion is left at " + std::to_string(left) +
                           "; ask for more with `finest`"}};
  }

  /// So many cells are left, about. Called by the caller's thread.
  void report(std::size_t left) const {
    if (options_.progress)
      options_.progress(
          progressOf(all_, std::min(left, all_), std::max<std::size_t>(options_.cells, 1)));
  }

  void dealAnew(const PieceStore& fused, std::vector<std::vector<CellMiddle>> middles,
                std::size_t cells) {
    std::vector<CellMiddle> all;
    for (const std::vector<CellMiddle>& some : middles)
      all.insert(all.end(), some.begin(), some.end());
    const std::uint32_t blocks = band_.blocks;
    const std::vector<std::vector<WholeVertex>> shared = std::move(band_.shared);
    beginBand(band_.number + 1, cells, std::move(all));
    workers_.forEach(blocks, 1, [&](std::size_t, std::size_t b) {
      const std::vector<MeshPiece> pieces = orThrow(fused.get(static_cast<std::uint32_t>(b)));
      for (const MeshPiece& piece : pieces) dealTo(piece, static_cast<std::uint32_t>(b), shared[b]);
    });
    endDeal();
  }

  /// Where the band ends: of the cells, `wanted` are left. No part is asked below `least`.
  float price(double wanted, double least) {
    std::vector<SampledParts> parts(band_.blocks);
    workers_.forEach(band_.blocks, 1, [&](std::size_t, std::size_t i) {
      const auto b = static_cast<std::uint32_t>(i);
      Block block = blockOf(b);
      if (block.piece.tetrahedra.empty()) return;
      const std::vector<LatticeBox> others = othersOf(b);
      block.others = others;
      parts[b] = sampleParts(block, frame_, kPartCells, kSampledOneIn,
                             std::max(kSampledTo * wanted, least));
    });
    std::vector<std::vector<PartLevel>> levels;
    std::size_t cells = 0;
    for (SampledParts& some : parts) {
      levels.insert(levels.end(), some.levels.begin(), some.levels.end());
      cells += some.cells;
    }
    return keyAt(levels, cells, wanted);
  }

  void addMoves(std::span<const BoundaryMove> moved) {
    BoundaryMove all;
    for (const BoundaryMove& one : moved) {
      all.toMesh = std::max(all.toMesh, one.toMesh);
      all.toOriginal = std::max(all.toOriginal, one.toOriginal);
      all.sum += one.sum, all.area += one.area;
    }
    tolerance_ -= std::min(frame_.options.envelopeTolerance.value_or(0),
                           all.toOriginal / frame_.samples->diagonal);
    toMesh_.max += all.toMesh;
    toOriginal_.max += all.toOriginal;
    if (all.area > 0) toOriginal_.mean += all.sum / all.area;
  }

  static std::size_t share(double of, std::size_t cells) {
    return static_cast<std::size_t>(of * static_cast<double>(cells));
  }

  BlockFrame frame_;
  const ReduceOptions& options_;
  Workers workers_;
  std::size_t all_, blockCells_;
  double tolerance_;  // that is left of the envelope's, over the diagonal
  std::mutex mutex_;  // of the band's boxes
  std::optional<BlockPlanes> planes_;
  SharedVertices shared_;
  Band band_;
  std::uint32_t bands_ = 0;
  bool isStuck_ = false;  // the last band was in vain: the next one goes on at any price
  OneSidedDistance toMesh_, toOriginal_;  // in lattice steps
};

ReducedMesh reduced(LatticePieces& original, const OriginalFigures& figures,
                    const FusionOptions& options, const ReduceOptions& reduce) {
  const CostFrame cost = orThrow(figures.costFrame(options.cost));
  ReducedMesh out{.mesh = {}, .missing = {}, .fusions = {cost, {}}, .samples = {}};
  out.tetrahedra = original.tetrahedra(), out.vertices = original.vertices();
  out.mesh.lattice = original.lattice();
  out.mesh.fields = original.fields();
  PieceShape shape{original.fields(), 0, 0};
  const std::size_t components = cost.basis.components();
  shape.quadricSums = FusionCost::sumsOf(components);
  shape.quadricSize = shape.quadricSums + components;
  OriginalSamples samples;
  samples.diagonal = figures.diagonal();
  Reduction reduction({original.lattice(), shape, cost, options, &samples}, reduce,
                      original.tetrahedra(), options.threads);
  OriginalSampler sampler(original, figures, {reduce.samples, reduce.surfaceSamples, reduce.seed});
  reduction.begin(figures.middles(), original, sampler);
  samples = sampler.samples();
  reduction.run();
  MeshPiece left = reduction.take();
  for (const PiecePlace& place : left.places)
    samples.places[place.number] = {samples.places[place.number].at, place.tetrahedron,
                                    place.isCovered != 0, place.isOriginal != 0};
  samples.toMesh = reduction.toMesh(), samples.toOriginal = reduction.toOriginal();
  out.samples = std::move(samples);
  out.mesh.points = std::move(left.points);
  out.mesh.values = std::move(left.values);
  out.mesh.tetrahedra = std::move(left.tetrahedra);
  out.mesh.boundary = boundaryOf(out.mesh.tetrahedra);
  assert(out.mesh.boundary.size() == left.boundary.size());
  out.missing = std::move(left.missing);
  out.fusions.quadrics = std::move(left.quadrics);
  out.bands = reduction.bands();
  out.envelopeTolerance = reduction.toleranceLeft();
  return out;
}

}  // namespace

Result<ReducedMesh> reduceMesh(LatticePieces& original, const OriginalFigures& figures,
                               const FusionOptions& options, const ReduceOptions& reduce) {
  assert(options.kept.empty() && reduce.blockCells > 0);
  return orCancelled([&]() -> Result<ReducedMesh> {
    try {
      return reduced(original, figures, options, reduce);
    } catch (const BlockFailed& failed) {
      return std::unexpected(failed.error);
    }
  });
}

}  // namespace qtet

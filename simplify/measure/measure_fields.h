// How far the fields of a level are from the original's, over the original's volume. Also how much
// of that volume the level does not cover.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "proto/level_error.h"
#include "simplify/measure/field_replay.h"
#include "simplify/measure/measure_samples.h"
#include "simplify/measure/measured_mesh.h"

namespace qtet {

class Workers;

struct FieldOptions {
  std::uint32_t samples = 0;  ///< places in the original's volume, uniform
  /// Vertices of the original at most, for the maximum: an error is largest at a vertex of one of
  /// the meshes.
  std::uint32_t vertices = 0;
  /// Whether what rounding has moved counts (MeasureOptions::countsRounding).
  bool countsRounding = false;
  std::vector<std::uint32_t> labels{};  ///< MeasureOptions::labels
  std::uint64_t seed = 0;
  Workers* workers = nullptr;  ///< not null; the result does not depend on how many they are
  /// Where the mesh was reduced before: its places instead of others. Without truth the fields are
  /// not measured.
  const OriginalSamples* before = nullptr;
};

/// The error of a field at a place is the Euclidean norm of the difference. It is relative to the
/// diagonal of the box that the original's values fill. For one component that is their range; for
/// a constant field the error is 0. The error of a label is 1 where it is another one, and its rms
/// is the mean of that: a share of the volume. Where the level's solid does not cover a place, its
/// value is that at the nearest point of its boundary. A cell field's value there is that of the
/// cell that held the place last. Places are followed from cell to cell through the fusions. A
/// place that the solid has left is covered again when a fusion at its nearest triangle covers it.
class FieldMeter {
 public:
  /// REQUIRES: `mesh` at its finest level. It must outlive this.
  FieldMeter(const MeasuredMesh& mesh, const FieldOptions& options);

  /// The step that `mesh` has just done.
  void follow();
  /// After follow(), before the figures are asked for. REQUIRES: the mesh's tree fits.
  void measure();
  /// Adds the level to `replay`. REQUIRES: it is measured.
  void keepIn(FieldReplay& replay);
  /// One a field of the history, in its order.
  [[nodiscard]] std::vector<FieldError> errors() const;
  /// How many of the uniform places the level does not cover, and how many there are.
  struct Uncovered {
    std::size_t places = 0, all = 0;
  };
  [[nodiscard]] Uncovered uncovered() const;
  /// The errors of the original from rounding alone.
  [[nodiscard]] std::vector<FieldError> roundings() const;
  /// Where place `i` is now. REQUIRES: it is measured.
  [[nodiscard]] FollowedPlace placeAt(std::size_t i) const;

 private:
  struct Place {
    // its cell is a ghost cell where the place is not covered: the nearest one
    ErrorSample sample;
    NearestTriangle nearest;  // of a place that is not covered
    CellId tetrahedron = 0;   // the last that covered it
    bool isMeasured = true, isKept = false;
    bool wasOriginal = true;  // at the finest level
  };

  [[nodiscard]] bool isLabel(std::size_t field) const {
    return std::ranges::find(options_.labels, field) != options_.labels.end();
  }
  void takePlaces(const OriginalSamples& before);
  void drawPlaces();
  void keepTruth();
  [[nodiscard]] double valueAt(const Place& place, std::size_t field, std::size_t component) const;
  void follow(Place& place) const;
  [[nodiscard]] bool findIn(const Fusion& fusion, Place& place) const;
  /// The nearest place of the boundary, for one that is not covered.
  void findOnBoundary(Place& place) const;
  void measure(std::size_t place);
  /// Whether the level has at the place what the original has.
  [[nodiscard]] bool isOriginal(const Place& place, std::size_t field) const;

  const MeasuredMesh& mesh_;
  FieldOptions options_;
  std::vector<Place> places_;
  std::size_t uniform_ = 0;                 // the first places, which the rms is taken over
  std::vector<double> ranges_;              // in field steps
  std::vector<std::vector<double>> truth_;  // per field, components a place
  std::vector<std::vector<double>> squaredErrors_;
};

}  // namespace qtet

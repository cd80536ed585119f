// Figures of a mesh by which weights are chosen, whether it is at hand or comes in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "simplify/cost/cost_parts.h"
#include "simplify/cost/label_fields.h"

namespace qtet {

class MeshFigures {
 public:
  virtual ~MeshFigures() = default;
  [[nodiscard]] virtual std::span<const FieldInfo> fields() const = 0;
  [[nodiscard]] virtual std::uint64_t tetrahedra() const = 0;
  /// As oneValueOf.
  [[nodiscard]] virtual std::span<const std::uint8_t> isOneValue() const = 0;
  /// As expectedFieldErrors.
  [[nodiscard]] virtual std::vector<double> fieldErrors(std::span<const CostPart> parts) const = 0;
  /// As balancedBoundaryWeight. Errors: those of reading the mesh.
  [[nodiscard]] virtual Result<double> boundaryWeight(std::span<const CostPart> parts,
                                                      std::span<const double> errors) const = 0;
  [[nodiscard]] virtual const LabelFinder& labels() const = 0;
};

/// Those of a mesh at hand, which must outlive them.
class LatticeFigures final : public MeshFigures {
 public:
  explicit LatticeFigures(const LatticeMesh& mesh);
  [[nodiscard]] std::span<const FieldInfo> fields() const override { return mesh_.fields; }
  [[nodiscard]] std::uint64_t tetrahedra() const override { return mesh_.tetrahedra.size(); }
  [[nodiscard]] std::span<const std::uint8_t> isOneValue() const override { return isOneValue_; }
  [[nodiscard]] std::vector<double> fieldErrors(std::span<const CostPart> parts) const override;
  [[nodiscard]] Result<double> boundaryWeight(std::span<const CostPart> parts,
                                              std::span<const double> errors) const override;
  [[nodiscard]] const LabelFinder& labels() const override { return labels_; }

 private:
  const LatticeMesh& mesh_;
  std::vector<std::uint8_t> isOneValue_;
  LabelFinder labels_;
};

}  // namespace qtet

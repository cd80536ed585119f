// A refiner's fields: blocks that follow the chunks of the mesh, at once or later. For refiner*.cpp
// and nobody else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/log/field_shape.h"
#include "codec/record/base_coder.h"
#include "codec/refine/patch_decoder.h"

namespace qtet {

struct ChunkPlan;

/// The elements that a chunk has added to the mesh.
struct AddedElements {
  Extent extent = Extent::kWhole;
  std::size_t firstBirth = 0, endBirth = 0;
  CellId endTetrahedron = 0;  // of the slots that it filled
};

class RefinerFields {
 public:
  /// All must outlive it. `base`: the births of the base mesh's vertices, once it is there.
  /// `added`: of each chunk that the mesh has, which a field has later.
  RefinerFields(const ChunkPlan& plan, const RecordReader& records,
                const std::vector<BaseBirth>& base, const std::vector<AddedElements>& added);

  /// Implements Refiner::applyField.
  Status apply(std::uint32_t field, std::uint32_t chunk, std::span<const std::int32_t> values);
  Status apply(std::uint32_t field, std::uint32_t chunk, ByteView block);
  /// Takes in that the plan has more fields than before.
  void planHasGrown();
  /// Implements Refiner::forgetField.
  void forget(std::uint32_t field) { fields_[field] = {}; }
  /// Implements Refiner::fieldsOnlyAt.
  void onlyAt(Association association, std::span<const std::uint32_t> elements);
  /// Gives a chunk's new elements stand-in values in every field, until the field's own block
  /// arrives.
  void inherit(std::uint32_t chunk);

  [[nodiscard]] std::uint32_t chunks(std::uint32_t field) const { return fields_[field].chunks; }
  [[nodiscard]] std::span<const std::int32_t> values(std::uint32_t field) const {
    return fields_[field].values;
  }

 private:
  struct Field {
    std::vector<std::int32_t> values;
    // of a field that is predicted in time: what its blocks hold
    std::vector<std::int32_t> differences;
    std::vector<std::uint8_t> sizes;  // where blocks are lifted (LiftedField)
    std::uint32_t chunks = 0;         // that have come
    bool broken = false;              // a block failed half-way: what it wrote is noise
  };

  /// A record, or a tetrahedron, whose values are coded though others' are not.
  struct Coded {
    std::uint32_t number;
    std::uint32_t place;  // tuples of its chunk before its own
  };
  /// A few elements, and by chunk all that codes their values: what they are predicted from, and
  /// they.
  struct Needed {
    Association association;
    std::vector<std::uint32_t> elements;
    std::vector<std::vector<Coded>> chunks;
  };

  [[nodiscard]] Status mayCome(std::uint32_t field, std::uint32_t chunk) const;
  void inheritPoints(Field& field, std::uint32_t components, std::size_t firstBirth) const;
  void inheritCells(Field& field, const FieldShape& shape, CellId first, CellId end) const;
  void codePoints(Field& field, const FieldShape& shape, std::uint32_t chunk,
                  Values& residuals) const;
  [[nodiscard]] Status codeLifted(Field& field, const FieldShape& shape, std::uint32_t chunk,
                                  ByteView block) const;
  void codeNeeded(Field& field, const FieldShape& shape, std::uint32_t chunk,
                  Values& residuals) const;
  [[nodiscard]] bool isNeededAlone(const FieldShape& shape) const {
    return needed_ && needed_->association == shape.association;
  }
  [[nodiscard]] std::vector<bool> neededRecords(std::span<const std::uint32_t> vertices) const;
  [[nodiscard]] std::vector<bool> neededCells(std::span<const std::uint32_t> cells) const;
  void codeRecord(std::vector<std::int32_t>& coded, const FieldShape& shape, const Birth& birth,
                  Values& residuals) const;
  void codeCell(std::vector<std::int32_t>& coded, const FieldShape& shape, CellId cell,
                Values& residuals) const;
  void codeBase(std::vector<std::int32_t>& coded, const FieldShape& shape, Values& residuals) const;
  void codeCells(Field& field, const FieldShape& shape, std::uint32_t chunk,
                 Values& residuals) const;
  /// The values of a point or cell, from its difference and the parents' values.
  void restore(Field& field, const FieldShape& shape, std::size_t element) const;

  const ChunkPlan& plan_;
  const RecordReader& records_;
  const std::vector<BaseBirth>& base_;
  const std::vector<AddedElements>& added_;
  std::vector<Field> fields_;
  std::optional<Needed> needed_;
};

}  // namespace qtet

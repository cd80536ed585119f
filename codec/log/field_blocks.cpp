#include "codec/log/field_blocks.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>

#include "codec/log/value_block.h"
#include "codec/record/lifted_values.h"

namespace qtet {
namespace {

/// The history's integers of a field, `components` a vertex or tetrahedron: an encoder reads them,
/// a decoder writes them.
template <bool kEncoding>
struct HistoryField {
  std::uint32_t components;
  bool hasMissing;
  std::span<std::conditional_t<kEncoding, const std::int32_t, std::int32_t>> values;

  [[nodiscard]] std::span<const std::int32_t> of(std::size_t element) const {
    assert((element + 1) * components <= values.size());
    return std::span<const std::int32_t>(values).subspan(element * components, components);
  }
};

std::unexpected<Error> refuse(std::uint32_t chunk, const std::string& what) {
  return fail(ErrorCode::kBadValue, "chunk " + std::to_string(chunk) + ": " + what);
}
constexpr const char* kBadValues = "field values out of range or left over";

/// Runs over a point field's values as its blocks come: `now` holds them by slot. A decoder notes a
/// fused vertex's just before it splits; those of the last level are left in `now`.
template <bool kEncoding>
void codePoints(const ValueOrder& order, std::uint32_t chunk, const HistoryField<kEncoding>& field,
                std::vector<std::int32_t>& now, Values& coded) {
  const std::size_t n = field.components;
  const auto at = [&](VertexId v, std::uint32_t c) -> std::int32_t& { return now[v * n + c]; };
  const auto truth = [&](VertexId v, std::uint32_t c) { return field.values[v * n + c]; };
  if (chunk == 0)
    for (VertexId v = 0; v < order.baseBirths.size(); ++v)
      for (std::uint32_t c = 0; c < n; ++c)
        at(v, c) = coded.codeField<kEncoding>(
            field.hasMissing, predictBaseField(order.baseBirths[v], v, c, field.hasMissing, at),
            truth(order.baseVertices[v], c));
  for (std::uint32_t b = order.chunkBirths[chunk]; b < order.chunkBirths[chunk + 1]; ++b) {
    const Birth& birth = order.points.births()[b];
    if constexpr (!kEncoding)
      for (std::uint32_t c = 0; c < n; ++c)
        field.values[order.fused[b] * n + c] = at(birth.slot, c);
    order.points.code<kEncoding>(
        birth, coded, field.components, at,
        [&](std::size_t i, std::uint32_t c) { return truth(order.prey[b][i], c); },
        field.hasMissing);
  }
}

template <bool kEncoding>
void codeCells(const ValueOrder& order, std::uint32_t chunk, const HistoryField<kEncoding>& field,
               Values& coded) {
  const std::size_t n = field.components;
  for (CellId t = order.chunkCells[chunk]; t < order.chunkCells[chunk + 1]; ++t)
    for (std::uint32_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return field.values[order.tetrahedra[u] * n + c]; };
      const std::int32_t value =
          coded.codeField<kEncoding>(field.hasMissing, order.cells.predict(t, at), at(t));
      if constexpr (!kEncoding) field.values[order.tetrahedra[t] * n + c] = value;
    }
}

/// The tuples of a Draco or an adaptive block: a record has one for each prey vertex.
std::uint32_t tuplesOf(const ValueOrder& order, std::uint32_t chunk, Association association) {
  if (association == Association::kCell)
    return order.chunkCells[chunk + 1] - order.chunkCells[chunk];
  auto tuples = static_cast<std::uint32_t>(chunk == 0 ? order.baseBirths.size() : 0);
  for (std::uint32_t b = order.chunkBirths[chunk]; b < order.chunkBirths[chunk + 1]; ++b)
    tuples += order.points.births()[b].k;
  return tuples;
}

/// Whether a chunk has values of point fields: a block of none has no bytes.
bool hasPointValues(const ValueOrder& order, std::uint32_t chunk) {
  return tuplesOf(order, chunk, Association::kPoint) > 0;
}

/// Codes the records of a chunk's block.
template <class Coder, class RuleOf, class TruthOf>
void codeLifted(const ValueOrder& order, std::uint32_t chunk, LiftedBlock<Coder>& block,
                const RuleOf& ruleOf, const TruthOf& truthOf) {
  const std::span<const std::uint32_t> starts = order.points.levelStarts();
  auto next = std::ranges::upper_bound(starts, order.chunkBirths[chunk]);
  LiftingRule rule;
  for (std::uint32_t b = order.chunkBirths[chunk]; b < order.chunkBirths[chunk + 1]; ++b) {
    const bool beginsLevel = next != starts.end() && b == *next;
    if (beginsLevel) ++next;
    if (beginsLevel || b == order.chunkBirths[chunk])
      rule = block.rule(ruleOf(static_cast<std::size_t>(next - starts.begin()) - 1));
    const Birth& birth = order.points.births()[b];
    block.record(rule, birth, order.points.slopesAt(birth), truthOf(b));
  }
}

class LiftedEncoder {
 public:
  LiftedEncoder(const ValueOrder& order, const HistoryField<true>& field, LiftingRules rules)
      : order_(order),
        field_(field),
        now_(order.vertices() * field.components),
        sizes_(now_.size()),
        rules_(std::move(rules)) {}

  Result<Bytes> block(std::uint32_t chunk) {
    if (!hasPointValues(order_, chunk)) return Bytes{};
    RangeEncoder encoder;
    LiftedBlock<RangeEncoder> block(encoder, {now_, sizes_}, field_.components, field_.hasMissing);
    if (chunk == 0)
      for (VertexId v = 0; v < order_.baseBirths.size(); ++v) {
        std::ranges::copy(field_.of(order_.baseVertices[v]),
                          now_.begin() + static_cast<std::ptrdiff_t>(v) * field_.components);
        block.base(v, order_.baseBirths[v]);
      }
    std::vector<std::int32_t> truth;
    codeLifted(
        order_, chunk, block, [&](std::size_t level) { return rules_[level]; },
        [&](std::uint32_t b) {
          truth.clear();
          for (std::size_t i = 0; i < order_.points.births()[b].k; ++i)
            std::ranges::copy(field_.of(order_.prey[b][i]), std::back_inserter(truth));
          return std::span<const std::int32_t>(truth);
        });
    if (block.bad())
      return fail(ErrorCode::kLimitExceeded,
                  "a difference of 2^31, which a value block cannot hold; use fewer bits");
    return encoder.finish();
  }

 private:
  const ValueOrder& order_;
  const HistoryField<true>& field_;
  std::vector<std::int32_t> now_;
  std::vector<std::uint8_t> sizes_;
  LiftingRules rules_;
};

/// Decodes a block into `now`, and notes the fused vertices' values.
Status decodeLifted(const ValueOrder& order, std::uint32_t chunk, ByteView bytes,
                    const HistoryField<false>& field, const LiftedField& now) {
  if (!hasPointValues(order, chunk))
    return bytes.empty() ? Status{} : refuse(chunk, "a value block of no values has bytes");
  if (std::uint64_t{tuplesOf(order, chunk, Association::kPoint)} * field.components >
      mostValuesIn(bytes))
    return fail(
        ErrorCode::kLimitExceeded,
        "chunk " + std::to_string(chunk) + ": a value block promises more than its bytes can hold");
  RangeDecoder decoder(bytes);
  LiftedBlock<RangeDecoder> block(decoder, now, field.components, field.hasMissing);
  if (chunk == 0)
    for (VertexId v = 0; v < order.baseBirths.size(); ++v) block.base(v, order.baseBirths[v]);
  codeLifted(
      order, chunk, block, [](std::size_t) { return LiftingRule{}; },
      [&](std::uint32_t b) {
        const std::size_t n = field.components;
        std::copy_n(
            now.values.begin() + static_cast<std::ptrdiff_t>(order.points.births()[b].slot * n), n,
            field.values.begin() + static_cast<std::ptrdiff_t>(order.fused[b] * n));
        return std::span<const std::int32_t>();
      });
  if (decoder.overrun())
    return fail(ErrorCode::kTruncated,
                "chunk " + std::to_string(chunk) + ": a value block ends before its values do");
  if (block.bad() || !decoder.atEnd()) return refuse(chunk, kBadValues);
  return {};
}

Result<std::vector<std::int32_t>> decodeLiftedBlocks(const ValueOrder& order,
                                                     const FieldShape& shape, std::size_t vertices,
                                                     const BlockOf& blockOf) {
  std::vector<std::int32_t> out(vertices * shape.components);
  const HistoryField<false> field{shape.components, shape.hasMissing, out};
  std::vector<std::int32_t> now(order.vertices() * shape.components);
  std::vector<std::uint8_t> sizes(now.size());
  for (std::uint32_t chunk = 0; chunk < order.chunks(); ++chunk) {
    const Result<ByteView> bytes = blockOf(chunk);
    if (!bytes) return std::unexpected(bytes.error());
    if (Status s = decodeLifted(order, chunk, *bytes, field, {now, sizes}); !s)
      return std::unexpected(s.error());
  }
  std::ranges::copy(now, out.begin());  // the last level's vertices come first
  return out;
}

}  // namespace

Result<std::vector<Bytes>> encodeFieldBlocks(const ValueOrder& order, const FieldInfo& field,
                                             std::span<const std::int32_t> values, CodecId codec,
                                             LiftingRules rules) {
  std::vector<Bytes> out;
  const HistoryField<true> truth{field.components, field.hasMissing, values};
  const CodecId own =
      blockCodec(codec, isCellField(field) ? Association::kCell : Association::kPoint);
  if (own == CodecId::kLifted) {
    if (rules.empty()) rules = exactRules(order, field, values);
    LiftedEncoder encoder(order, truth, std::move(rules));
    for (std::uint32_t chunk = 0; chunk < order.chunks(); ++chunk) {
      Result<Bytes> block = encoder.block(chunk);
      if (!block) return std::unexpected(block.error());
      out.push_back(std::move(*block));
    }
    return out;
  }
  std::vector<std::int32_t> now(isCellField(field) ? 0 : order.vertices() * field.components);
  for (std::uint32_t chunk = 0; chunk < order.chunks(); ++chunk) {
    Values coded;
    if (isCellField(field))
      codeCells(order, chunk, truth, coded);
    else
      codePoints(order, chunk, truth, now, coded);
    // as many as a decoder will ask for
    assert(coded.written().size() ==
           std::size_t{tuplesOf(order, chunk,
                                isCellField(field) ? Association::kCell : Association::kPoint)} *
               field.components);
    Result<Bytes> block = encodeValueBlock(coded.written(), field.components, own);
    if (!block) return std::unexpected(block.error());
    out.push_back(std::move(*block));
  }
  return out;
}

Result<std::vector<std::int32_t>> decodeFieldBlocks(const ValueOrder& order,
                                                    const FieldShape& shape, std::size_t vertices,
                                                    CodecId codec, const BlockOf& blockOf) {
  const CodecId own = blockCodec(codec, shape.association);
  if (own == CodecId::kLifted) return decodeLiftedBlocks(order, shape, vertices, blockOf);
  const bool ofCells = shape.association == Association::kCell;
  std::vector<std::int32_t> out((ofCells ? order.tetrahedra.size() : vertices) * shape.components);
  const HistoryField<false> field{shape.components, shape.hasMissing, out};
  std::vector<std::int32_t> now(ofCells ? 0 : order.vertices() * shape.components);
  for (std::uint32_t chunk = 0; chunk < order.chunks(); ++chunk) {
    const Result<ByteView> bytes = blockOf(chunk);
    if (!bytes) return std::unexpected(bytes.error());
    const auto block =
        decodeValueBlock(*bytes, shape.components, tuplesOf(order, chunk, shape.association), own);
    if (!block) return std::unexpected(block.error());
    Values in(*block);
    if (ofCells)
      codeCells(order, chunk, field, in);
    else
      codePoints(order, chunk, field, now, in);
    if (in.bad() || !in.atEnd()) return refuse(chunk, kBadValues);
  }
  std::ranges::copy(now, out.begin());  // the last level's vertices come first
  return out;
}

}  // namespace qtet

// A field's blocks of all chunks, in both directions, from the order of a log's elements.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/log/codec_id.h"
#include "codec/log/field_lifting.h"
#include "codec/log/field_shape.h"
#include "codec/mesh/mesh.h"
#include "codec/record/value_order.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// One field's block of every chunk. `values` holds components integers for each of the history's
/// vertices or, of a cell field, tetrahedra. `rules`: those of a lifted field's levels; exactRules
/// if none. Errors: limit-exceeded, bad-codec.
[[nodiscard]] Result<std::vector<Bytes>> encodeFieldBlocks(const ValueOrder& order,
                                                           const FieldInfo& field,
                                                           std::span<const std::int32_t> values,
                                                           CodecId codec, LiftingRules rules = {});

/// The block of a chunk.
using BlockOf = std::function<Result<ByteView>(std::uint32_t chunk)>;

/// The inverse: the integers that a field's writer had, those of fused vertices too. `vertices`: of
/// the history. Errors: those of `blockOf`, bad-value, truncated, limit-exceeded, bad-codec.
[[nodiscard]] Result<std::vector<std::int32_t>> decodeFieldBlocks(const ValueOrder& order,
                                                                  const FieldShape& field,
                                                                  std::size_t vertices,
                                                                  CodecId codec,
                                                                  const BlockOf& blockOf);

}  // namespace qtet

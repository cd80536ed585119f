// Writes levels as runs of whole chunks, which split every vertex of the mesh that may split.
#pragma once

#include <cstdint>

#include "codec/log/log_writer.h"
#include "codec/log/record_writer.h"

namespace qtet {

/// Writes levels 1 to `levels` behind the base mesh, whose chunk is open. The last chunk stays
/// open: of 0 levels the base mesh's. Errors: those of encodeLog.
Status writeLevelRuns(RecordWriter& writer, std::uint32_t levels, const LogWriterOptions& options);

}  // namespace qtet

// A level of a log as a mesh file, written field after field.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "codec/refine/log_file.h"
#include "proto/byte_sink.h"

namespace qtet {

/// The file that meshFileBytes(meshAtLevel(log, level, fields), ending) makes, piece by piece. In
/// memory are the mesh, one field, and those that later ones are predicted from. `fields` ascend.
/// `names` are those in the file; empty: the manifest's. REQUIRES: an ending of kWrittenEndings
/// that needs no lattice. Errors: meshAtLevel's, the writers' (mesh_file.h), the sink's.
[[nodiscard]] Status writeLevel(const LogFile& log, std::uint32_t level,
                                std::span<const std::uint32_t> fields,
                                std::span<const std::string> names, std::string_view ending,
                                const ByteSink& sink, const std::stop_token& stop = {});

}  // namespace qtet

// The manifest in a log, both ways (FORMAT.md, "Manifest"). The manifest does not repeat header and
// chunk table, so it cannot contradict them. Only whether a field has missing values is stored in
// both.
#pragma once

#include <cstddef>
#include <cstdint>

#include "proto/bytes.h"
#include "proto/error.h"
#include "proto/manifest.h"

namespace qtet {

struct LogIndex;

/// Puts the manifest into the index, in the two parts that a log has (FORMAT.md, "Later
/// instants"). The first of the later fields is the first instant that is not its series' first. An
/// opening that names a later field goes, and so does a unit of no field. Errors: manifestBlock's.
/// REQUIRES: an index that has the shapes of these fields.
[[nodiscard]] Status setManifest(LogIndex& index, Manifest manifest);

/// LogIndex::encodeLater, if a log may have so large a part. Errors: limit-exceeded.
[[nodiscard]] Result<Bytes> laterPart(const LogIndex& index);

/// The bytes of LogIndex::manifest, without the last `later` fields. Errors are rounded up to three
/// significant digits (codec/coding/error_figure.h). If a level has one, the first and the last
/// have one. Errors: bad-value (an error that is no number or out of range, a name too long),
/// limit-exceeded (above kMaxManifestBytes). REQUIRES: at least one level.
[[nodiscard]] Result<Bytes> manifestBlock(const Manifest& manifest, std::size_t later = 0);

/// The bytes of LogIndex::laterManifest: of the last `later` fields. REQUIRES: a manifest that
/// manifestBlock takes.
[[nodiscard]] Bytes laterManifestBlock(const Manifest& manifest, std::size_t later);

/// Reads index.manifest and, if the index has later fields, index.laterManifest. The rest of the
/// index gives bits of the lattice, shapes of the fields, the number of levels and each level's
/// chunk. Errors: truncated; limit-exceeded (found before anything is allocated); bad-value with
/// what is out of range, and for bytes left over.
[[nodiscard]] Result<Manifest> manifestOf(const LogIndex& index);

}  // namespace qtet

// A log that is made and not yet written.
#pragma once

#include <cstdint>
#include <memory>

#include "codec/files/byte_spool.h"

namespace qtet {

struct MadeLog {
  Bytes head;  ///< header, manifest, table
  std::unique_ptr<ByteSpool> blocks;
  Bytes later;  ///< the part of later instants

  [[nodiscard]] std::uint64_t size() const { return head.size() + blocks->size() + later.size(); }
  /// All of its bytes, in order. Errors: io, the sink's.
  [[nodiscard]] Status writeTo(const ByteSink& sink) const {
    if (Status s = sink(head); !s) return s;
    if (Status s = blocks->writeTo(sink); !s) return s;
    return sink(later);
  }
  /// The same in memory. Errors: io.
  [[nodiscard]] Result<Bytes> bytes() const {
    Bytes out;
    out.reserve(static_cast<std::size_t>(size()));
    if (Status s = writeTo(appendTo(out)); !s) return std::unexpected(s.error());
    return out;
  }
};

}  // namespace qtet

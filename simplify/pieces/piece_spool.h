// Pieces that wait in a spool, by their numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "codec/files/byte_spool.h"
#include "proto/bytes.h"
#include "simplify/blocks/piece_store.h"

namespace qtet {

class PieceSpool {
 public:
  /// In memory without `make`. Errors: those of `make`.
  [[nodiscard]] static Result<PieceSpool> made(const MakeSpool& make);

  /// Errors: io.
  Status add(const Bytes& bytes);
  [[nodiscard]] std::size_t count() const { return ends_.size(); }
  /// Errors: io. REQUIRES: number < count().
  [[nodiscard]] Result<Bytes> get(std::size_t number) const;

 private:
  explicit PieceSpool(std::unique_ptr<ByteSpool> spool) : spool_(std::move(spool)) {}

  std::unique_ptr<ByteSpool> spool_;
  std::vector<std::uint64_t> ends_;
};

}  // namespace qtet

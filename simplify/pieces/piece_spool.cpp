#include "simplify/pieces/piece_spool.h"

#include <cassert>

namespace qtet {

Result<PieceSpool> PieceSpool::made(const MakeSpool& make) {
  if (!make) return PieceSpool(std::make_unique<MemorySpool>());
  Result<std::unique_ptr<ByteSpool>> spool = make();
  if (!spool) return std::unexpected(spool.error());
  return PieceSpool(std::move(*spool));
}

Status PieceSpool::add(const Bytes& bytes) {
  if (Status s = spool_->append(bytes); !s) return s;
  ends_.push_back(spool_->size());
  return {};
}

Result<Bytes> PieceSpool::get(std::size_t number) const {
  assert(number < ends_.size());
  const std::uint64_t begin = number == 0 ? 0 : ends_[number - 1];
  Bytes out(ends_[number] - begin);
  if (Status s = spool_->read(begin, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace qtet

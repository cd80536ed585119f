#include "codec/mesh/original_cells.h"

#include <algorithm>
#include <array>

#include "codec/coding/range_coder.h"

namespace qtet {
namespace {

template <class Coder>
class OriginalCellCoder {
 public:
  explicit OriginalCellCoder(Coder& coder) : coder_(coder) {}

  /// Codes every number; an encoder's are read, a decoder's written. False: damaged.
  template <class Overrun>
  [[nodiscard]] bool run(std::vector<std::uint32_t>& ids, const Overrun& overrun) {
    std::int64_t before = -1;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (i == 0 || coder_.bit(ids[i] == before, same_[run_][lastRun_]) == 0) {
        before += step(ids[i] - before);
        lastRun_ = run_, run_ = 1;
      } else {
        run_ = std::min(run_ + 1, kLongest);
      }
      if (overrun() || before < 0 || before >= kOriginalCellEnd) return false;
      ids[i] = static_cast<std::uint32_t>(before);
    }
    return true;
  }

 private:
  // Longer runs count as so long: a hexahedron is six tetrahedra, one with all its nodes 48.
  static constexpr std::size_t kLongest = 63;

  std::int64_t step(std::int64_t truth) {
    if (coder_.bit(truth == 1, next_) != 0) return 1;
    const bool negative = coder_.bit(truth < 0, negative_) != 0;
    const auto size = static_cast<std::int64_t>(
        size_.code(coder_, static_cast<std::uint32_t>(truth < 0 ? -truth : truth)));
    return negative ? -size : size;
  }

  Coder& coder_;
  std::size_t run_ = 0, lastRun_ = 0;
  std::array<std::array<BitModel, kLongest + 1>, kLongest + 1> same_;
  BitModel next_, negative_;
  NumberModel size_;
};

}  // namespace

Bytes encodeOriginalCells(std::span<const std::uint32_t> ids) {
  RangeEncoder encoder;
  std::vector<std::uint32_t> numbers(ids.begin(), ids.end());
  (void)OriginalCellCoder<RangeEncoder>(encoder).run(numbers, [] { return false; });
  return encoder.finish();
}

Result<std::vector<std::uint32_t>> decodeOriginalCells(ByteView bytes, std::size_t cells) {
  RangeDecoder decoder(bytes);
  std::vector<std::uint32_t> ids(cells);
  if (!OriginalCellCoder<RangeDecoder>(decoder).run(ids, [&] { return decoder.overrun(); }) ||
      !decoder.atEnd())
    return fail(ErrorCode::kBadValue,
                "the block of original cells contradicts itself; fetch or build the log again");
  return ids;
}

}  // namespace qtet

#include "codec/coding/value_digits.h"

namespace qtet {

SymbolsAndDigits splitValues(std::span<const std::int32_t> values) {
  SymbolsAndDigits out;
  out.symbols.reserve(values.size());
  std::uint64_t pending = 0;
  int bits = 0;
  for (const std::int32_t value : values) {
    const digits::Split s = digits::split(value);
    out.symbols.push_back(s.symbol);
    pending |= std::uint64_t{s.digits} << bits;
    for (bits += s.count; bits >= 8; bits -= 8, pending >>= 8)
      out.digits.push_back(static_cast<std::uint8_t>(pending));
  }
  if (bits > 0) out.digits.push_back(static_cast<std::uint8_t>(pending));
  return out;
}

Result<std::vector<std::int32_t>> joinValues(std::span<const std::int32_t> symbols,
                                             ByteView bytes) {
  std::vector<std::int32_t> values;
  values.reserve(symbols.size());
  std::uint64_t pending = 0;
  int bits = 0;
  std::size_t next = 0;
  for (const std::int32_t symbol : symbols) {
    if (symbol <= -digits::kSymbols || symbol >= digits::kSymbols)
      return fail(ErrorCode::kBadValue, "a value block holds a symbol that does not exist");
    const int count = digits::countOf(symbol);
    for (; bits < count; bits += 8) {
      if (next == bytes.size())
        return fail(ErrorCode::kBadValue, "a value block has fewer digits than its symbols need");
      pending |= std::uint64_t{bytes[next++]} << bits;
    }
    values.push_back(digits::join(
        symbol, static_cast<std::uint32_t>(pending & ((std::uint64_t{1} << count) - 1))));
    pending >>= count;
    bits -= count;
  }
  if (next != bytes.size() || pending != 0)
    return fail(ErrorCode::kBadValue, "a value block has more digits than its symbols need");
  return values;
}

}  // namespace qtet

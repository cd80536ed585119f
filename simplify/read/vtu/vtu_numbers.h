// The numbers of one array of a .vtu file, from ascii or from bytes, a batch at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "simplify/read/vtu/vtu_document.h"

namespace qtet {

/// Some of an array's numbers: `count` of them from `first` on. The file's counts say that it has
/// `told` in all, where each component of a tuple counts. REQUIRES: first + count <= told.
struct NumberRange {
  std::uint64_t told = 0, first = 0, count = 0;
};

template <class T>
using TakeNumbers = std::function<void(std::span<const T>)>;

/// How many of the numbers may be reserved before any is read: all, unless a compressed array
/// promises more than can be known yet. Errors: bad-input (fewer than `told` numbers, by its own
/// words or by its bytes; a kind without numbers), truncated, io.
[[nodiscard]] Result<std::uint64_t> certainNumbers(const VtuFile& file, const VtuDocument& document,
                                                   const VtuArray& array, std::uint64_t told);

/// Gives the range's numbers to `take`, in order. Floats become doubles with every bit of a NaN
/// (float_bits.h). Errors: those of certainNumbers; bad-input (a word that is no number of the
/// array's type; other than `told` numbers of ascii; bytes that do not inflate).
[[nodiscard]] Status readReals(const VtuFile& file, const VtuDocument& document,
                               const VtuArray& array, const NumberRange& range,
                               const TakeNumbers<double>& take);

/// The same as integers. Those of UInt64 beyond 2^63 are negative, as VTK has them, and a float
/// that no such integer holds is -1.
[[nodiscard]] Status readIntegers(const VtuFile& file, const VtuDocument& document,
                                  const VtuArray& array, const NumberRange& range,
                                  const TakeNumbers<std::int64_t>& take);

}  // namespace qtet

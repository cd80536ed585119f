// Time steps of a series, whichever format it has.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// "first", "last" and "all" in small letters, in whatever case they were given; anything else as
/// it is.
[[nodiscard]] std::string timeWord(const std::string& asked);

/// The numbers of the steps that `asked` means, ascending: a timeWord, or the times of one or
/// several between commas (placeOfTime). FROM:TO:EVERY means every so many of those between two
/// times. Each part of it may be left out. ~T means the time nearest to T, and of two the earlier.
/// A note names it where it is another. A word means all of them where there is one or none. A note
/// says that the last was taken of several. `times` ascend. Errors: not-found (no such step), with
/// the times that there are; bad-value (a range of other parts).
[[nodiscard]] Result<std::vector<std::size_t>> chosenSteps(const std::vector<double>& times,
                                                           const std::string& asked,
                                                           const std::filesystem::path& path,
                                                           std::vector<std::string>& notes);

}  // namespace qtet

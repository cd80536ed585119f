#include "simplify/words/option_names.h"

#include <string_view>
#include <utility>

namespace qtet {
namespace {

/// Those of SimplifyOptions, ReadOptions and qtet_simplify_options that messages name.
constexpr std::pair<std::string_view, std::string_view> kOptions[] = {
    {"`algorithm`", "--algorithm"},
    {"`baseCells`", "--base-cells"},
    {"`boundaryWeight`", "--boundary-weight"},
    {"`curved`", "--curved"},
    {"`envelopeTolerance`", "--envelope-tolerance"},
    {"`errors`", "--error"},
    {"`fieldBits`", "--field-bits"},
    {"`fields`", "--fields"},
    {"`fieldWeights`", "--field-weight"},
    {"`labelWeights`", "--label-weight"},
    {"`finest`", "--finest"},
    {"`format`", "--format"},
    {"`keepOrder`", "--keep-order"},
    {"`lossless`", "--lossless"},
    {"`maxBoundaryError`", "--max-boundary-error"},
    {"`measure`", "--measure"},
    {"`memory`", "--memory"},
    {"`originalIds`", "--original-ids"},
    {"`parts`", "--parts"},
    {"`readSeconds`", "--read-seconds"},
    {"`regions`", "--preserve-regions"},
    {"`targetRatio`", "--target-ratio"},
    {"`threshold`", "--threshold"},
    {"`time`", "--time"},
    {"`times`", "--times"},
    {"`timeStatistics`", "--time-statistics"},
    {"`units`", "--unit"},
    {"`weld`", "--weld"},
};

}  // namespace

std::string withOptionNames(std::string text) {
  for (const auto& [member, option] : kOptions)
    for (std::size_t at = 0; (at = text.find(member, at)) != std::string::npos; at += option.size())
      text.replace(at, member.size(), option);
  return text;
}

std::vector<std::string> withOptionNames(std::vector<std::string> texts) {
  for (std::string& text : texts) text = withOptionNames(std::move(text));
  return texts;
}

}  // namespace qtet

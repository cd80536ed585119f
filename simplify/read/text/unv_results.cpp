#include "simplify/read/text/unv_results.h"

#include <algorithm>
#include <limits>
#include <span>

#include "proto/limits.h"
#include "simplify/read/text/plain_words.h"
#include "simplify/read/text/unv_numbers.h"

namespace qtet {
namespace {

/// Datasets of results elsewhere than at nodes.
constexpr auto kOtherResults = std::to_array<std::string_view>({"56", "57", "2415", "2416"});
/// Where results are, in dataset 2414.
constexpr int kAtNodes = 1;
/// Kinds of numbers: the first is dataset 55's "real", too.
constexpr std::int64_t kSingle = 2, kDouble = 4;
constexpr std::int64_t kSymmetricTensor = 4, kGeneralTensor = 5;
/// VTK's components xx yy zz xy yz xz among the file's xx xy yy xz yz zz, and VTK's rows among the
/// file's columns.
constexpr std::array<std::uint8_t, 6> kSymmetricOrder{0, 2, 5, 1, 4, 3};
constexpr std::array<std::uint8_t, 9> kGeneralOrder{0, 3, 6, 1, 4, 7, 2, 5, 8};
/// Types of results by their number, from 2 on.
constexpr auto kResultTypes = std::to_array<std::string_view>(
    {"Stress", "Strain", "Element force", "Temperature", "Heat flux", "Strain energy",
     "Displacement", "Reaction force", "Kinetic energy", "Velocity", "Acceleration",
     "Strain energy density", "Kinetic energy density", "Hydro-static pressure", "Heat gradient",
     "Code checking value", "Coefficient of pressure"});
constexpr std::int64_t kFirstType = 2;
/// Numbers of a line of dataset 55, and the most of each kind that its head may have.
constexpr std::int64_t kIntegersOfALine = 8, kRealsOfALine = 6;
constexpr std::int64_t kMostIntegers = 10, kMostReals = 12;
/// A result at fewer than one of so many nodes would take memory that the file's size does not
/// bound.
constexpr std::size_t kFewNodes = 16;

std::string_view resultType(std::int64_t type) {
  const std::int64_t at = type - kFirstType;
  return at >= 0 && at < std::ssize(kResultTypes) ? kResultTypes[static_cast<std::size_t>(at)] : "";
}

/// Where each component stands in the file; empty: in the same place.
std::span<const std::uint8_t> tensorOrder(std::int64_t characteristic, std::int64_t components) {
  if (characteristic == kSymmetricTensor && components == std::ssize(kSymmetricOrder))
    return kSymmetricOrder;
  if (characteristic == kGeneralTensor && components == std::ssize(kGeneralOrder))
    return kGeneralOrder;
  return {};
}

std::int64_t recordLines(std::int64_t numbers, std::int64_t each) {
  return std::max<std::int64_t>(1, (numbers + each - 1) / each);
}

}  // namespace

void UnvResults::note(const std::string& text) {
  if (noted_.insert(text).second) notes_.push_back(text);
}

bool UnvResults::read(std::string_view dataset) {
  if (std::ranges::find(kOtherResults, dataset) != kOtherResults.end()) {
    note("results of a dataset " + std::string(dataset) +
         " are not read; those at nodes of datasets 55 and 2414 are");
    skipUnvDataset(in_);
    return true;
  }
  if (dataset == "55")
    read55();
  else if (dataset == "2414")
    read2414();
  else
    return false;
  return true;
}

UnvResults::Head UnvResults::head(std::string_view called,
                                  const std::array<std::string, 5>& idLines) {
  std::array<std::int64_t, 6> numbers{};
  for (std::int64_t& number : numbers) number = in_.number<std::int64_t>("a kind of result");
  Head out;
  out.characteristic = numbers[2], out.kind = numbers[4], out.components = numbers[5];
  // The second of these lines is the type's name where its number says none.
  for (const std::string_view name :
       {called, resultType(numbers[3]), std::string_view(idLines[1]), std::string_view(idLines[0])})
    if (out.name.empty() && capitals(name) != "NONE") out.name = name;
  if (out.name.empty()) out.name = "Result";
  return out;
}

void UnvResults::read55() {
  std::array<std::string, 5> idLines;
  for (std::string& line : idLines) line = in_.line();
  const Head found = head("", idLines);
  in_.skipLine();
  const auto integers = in_.number<std::int64_t>("a number of integers"),
             reals = in_.number<std::int64_t>("a number of real numbers");
  in_.skipLine();
  if (in_.failed()) return;
  if (integers < 0 || integers > kMostIntegers || reals < 0 || reals > kMostReals)
    return in_.fail(ErrorCode::kBadInput,
                    "the result " + shownField(found.name) + " has " + std::to_string(integers) +
                        " integers and " + std::to_string(reals) +
                        " real numbers before its values; the file is damaged, export it again");
  const std::int64_t lines =
      recordLines(2 + integers, kIntegersOfALine) - 1 + recordLines(reals, kRealsOfALine);
  for (std::int64_t i = 0; i < lines; ++i) in_.line();
  readValues(found);
}

void UnvResults::read2414() {
  in_.line();  // its number
  const std::string name(in_.line());
  const auto place = in_.number<int>("where the results are");
  in_.skipLine();
  std::array<std::string, 5> idLines;
  for (std::string& line : idLines) line = in_.line();
  Head found = head(name, idLines);
  found.isAtNodes = place == kAtNodes;
  in_.skipLine();
  for (int i = 0; i < 4; ++i) in_.line();
  readValues(found);
}

void UnvResults::readValues(const Head& head) {
  if (in_.failed()) return;
  const char* why = nullptr;
  if (!head.isAtNodes)
    why = "they are not at nodes";
  else if (head.kind != kSingle && head.kind != kDouble)
    why = "they are no real numbers";
  else if (head.components < 1 || head.components > kMaxFieldComponents)
    why = "they have too many numbers at a node, or none";
  if (why) {
    note("the results " + shownField(head.name) + " are not read: " + why);
    return skipUnvDataset(in_);
  }
  const auto order = tensorOrder(head.characteristic, head.components);
  Values out{head.kind == kSingle ? "float32" : "float64",
             static_cast<std::uint32_t>(head.components),
             {},
             {}};
  std::vector<double> tuple(out.components);
  while (!in_.failed()) {
    const std::int64_t node = unvLabel(in_);
    if (node == -1) break;
    if (in_.failed() || !isUnvNode(in_, node)) return;
    out.nodes.push_back(static_cast<std::uint32_t>(node));
    for (double& value : tuple) value = unvReal(in_);
    for (std::size_t c = 0; c < tuple.size(); ++c)
      out.values.push_back(tuple[order.empty() ? c : order[c]]);
  }
  in_.skipLine();
  if (results_.contains(head.name))
    note("of several results " + shownField(head.name) + " the last one is read");
  results_[head.name] = std::move(out);
}

void UnvResults::addTo(CellMesh& mesh, const NumberTable& nodes) const {
  for (const auto& [name, result] : results_) {
    if (result.nodes.size() < mesh.points.size() / kFewNodes) {
      notes_.push_back("the results " + name + " are left out: few nodes have them");
      continue;
    }
    MeshField field{name, result.components, result.type, {}, "point"};
    field.values.assign(mesh.points.size() * result.components,
                        std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < result.nodes.size(); ++i) {
      const auto at = nodes.find(result.nodes[i]);
      if (at == nodes.end()) continue;
      std::copy_n(result.values.begin() + static_cast<std::ptrdiff_t>(i * result.components),
                  result.components,
                  field.values.begin() +
                      static_cast<std::ptrdiff_t>(std::size_t{at->second} * result.components));
    }
    mesh.fields.push_back(std::move(field));
  }
}

}  // namespace qtet

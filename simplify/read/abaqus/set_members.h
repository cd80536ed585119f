// Which cells of the mesh are in a set of elements of an Abaqus file.
#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "simplify/read/abaqus/abaqus_model.h"
#include "simplify/read/process/reading_time.h"

namespace qtet {

/// A part where it stands in the mesh.
struct AbaqusCopy {
  std::size_t part = 0;
  const AbaqusInstance* instance = nullptr;  ///< nullptr: the part stands as it is
  std::uint32_t firstCell = 0;
};

/// The model and the copies must outlive it.
class SetMembers {
 public:
  /// `cells`: of all copies together.
  SetMembers(const AbaqusModel& model, const std::vector<AbaqusCopy>& copies, std::size_t cells,
             ReadingTime time);

  /// Puts the cells of the set `name` (by abaqusName) that `part` has into `out`, each once. A set
  /// that is not there has no cells. Nothing is added when no time is left.
  void add(std::size_t part, std::string_view name, std::vector<std::uint32_t>& out);
  [[nodiscard]] bool isOver() const { return isOver_; }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  /// A set as one copy has it; kNone: that of the assembly, which has no cells of its own.
  struct Task {
    std::size_t part, copy, set;
    auto operator<=>(const Task&) const = default;
  };

  void push(std::size_t part, std::size_t copy, std::string_view name);
  void addPiece(const Task& task, const AbaqusSetPiece& piece, std::vector<std::uint32_t>& out);
  void addRange(std::size_t copy, const NumberRange& range, std::vector<std::uint32_t>& out);
  bool look();

  const AbaqusModel& model_;
  const std::vector<AbaqusCopy>& copies_;
  ReadingTime time_;
  bool isOver_ = false;
  std::uint32_t untilLook_ = 1;
  std::map<std::string, std::size_t, std::less<>> instances_;  ///< copies by abaqusName
  std::vector<std::vector<std::size_t>> copiesOf_;             ///< one a part
  std::vector<std::vector<std::uint32_t>> byNumber_;           ///< a part's cells, ascending
  std::vector<Task> tasks_;
  std::vector<Task> seen_;            ///< sorted
  std::vector<std::uint32_t> taken_;  ///< one a cell: the call that added it
  std::uint32_t call_ = 0;
};

/// The part's cells by ascending numbers of their elements.
[[nodiscard]] std::vector<std::uint32_t> cellsByNumber(const AbaqusPart& part);

}  // namespace qtet

#include "simplify/read/steps/cell_transfer.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <new>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "proto/limits.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {
namespace {

// One description of the bytes for both directions: `io` is a Sender, and the rest constant, or a
// Receiver.

template <class Io, class Field>
void transferField(Io& io, Field& field) {
  io.name(field.name), io.one(field.components), io.list(field.type);
  io.list(field.values), io.list(field.association), io.names(field.labelNames);
}

template <class Io, class Label>
void transferLabel(Io& io, Label& label) {
  io.list(label.name), io.list(label.values), io.names(label.names);
}

template <class Io, class Step>
void transferStep(Io& io, Step& step) {
  auto& mesh = step.cells;
  io.list(step.time), io.list(mesh.points), io.list(mesh.types), io.list(mesh.begins);
  io.list(mesh.vertices), io.list(mesh.cellIds), io.list(mesh.pointType), io.list(mesh.pointIds);
  io.each(mesh.fields, [&](auto& field) { transferField(io, field); });
  io.each(mesh.otherFields, [&](auto& name) { io.list(name); });
  io.each(mesh.labels, [&](auto& label) { transferLabel(io, label); });
}

template <class Io, class Report>
void transferReport(Io& io, Report& report) {
  io.one(report.ignoredCells), io.one(report.pieces), io.one(report.joinedPoints);
  io.one(report.joinedByIds), io.list(report.times);
  io.each(report.ignoredFields, [&](auto& name) { io.list(name); });
  io.each(report.notes, [&](auto& note) { io.list(note); });
  io.one(report.blocksMeet), io.pairs(report.differingBlocks);
}

class Sender {
 public:
  explicit Sender(int file) : file_(file) {}

  template <class T>
  void one(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::as_bytes(std::span(&value, 1)));
  }
  template <class List>
  void list(const List& values) {
    one(std::uint64_t{values.size()});
    put(std::as_bytes(std::span(values)));
  }
  void name(const FieldName& name) { list(name.text()); }
  template <class T, class Each>
  void each(const std::vector<T>& values, const Each& each) {
    one(std::uint64_t{values.size()});
    for (const T& value : values) each(value);
  }
  /// The first kMaxLabelNames: a log has no more.
  void names(const LabelNames& names) {
    const auto count = std::min<std::uint64_t>(names.size(), kMaxLabelNames);
    one(count);
    for (const auto& [value, name] : std::views::take(names, static_cast<std::ptrdiff_t>(count)))
      one(value), list(name);
  }
  void pairs(const BlockPairs& pairs) {
    one(std::uint64_t{pairs.size()});
    for (const auto& [name, other] : pairs) list(name), list(other);
  }

 private:
  void put(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) throw std::bad_alloc();
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  int file_;
};

/// Gives zeros and empty lists once it has failed.
class Receiver {
 public:
  explicit Receiver(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void one(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(sizeof(T), &value);
  }
  template <class List>
  void list(List& values) {
    using T = typename List::value_type;
    std::uint64_t size = 0;
    one(size);
    if (size > bytes_.size() / sizeof(T)) failed_ = true;
    if (failed_) return;
    values.resize(size);
    take(size * sizeof(T), values.data());
  }
  void name(FieldName& name) {
    std::string text;
    list(text);
    name = std::move(text);
  }
  template <class T, class Each>
  void each(std::vector<T>& values, const Each& each) {
    std::uint64_t size = 0;
    one(size);
    if (size > bytes_.size()) failed_ = true;  // each takes a byte at least
    for (std::uint64_t i = 0; i < size && !failed_; ++i) each(values.emplace_back());
  }
  void names(LabelNames& names) {
    std::uint64_t count = 0;
    one(count);
    if (count > kMaxLabelNames) failed_ = true;
    for (std::uint64_t i = 0; i < count && !failed_; ++i) {
      std::int32_t value = 0;
      std::string name;
      one(value), list(name);
      if (!name.empty()) names.emplace(value, std::move(name));
    }
  }

  void pairs(BlockPairs& pairs) {
    std::uint64_t count = 0;
    one(count);
    if (count > bytes_.size()) failed_ = true;  // each takes a byte at least
    for (std::uint64_t i = 0; i < count && !failed_; ++i) {
      std::string name, other;
      list(name), list(other);
      pairs.emplace(std::move(name), std::move(other));
    }
  }

  [[nodiscard]] bool failed() const { return failed_; }

 private:
  void take(std::size_t size, void* to) {
    if (size > bytes_.size()) failed_ = true;
    if (failed_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }

  std::span<const std::byte> bytes_;
  bool failed_ = false;
};

/// The whole file as memory while this lives; empty where that cannot be.
class Mapped {
 public:
  explicit Mapped(int file) {
    struct stat info{};
    if (::fstat(file, &info) != 0 || info.st_size <= 0) return;
    size_ = static_cast<std::size_t>(info.st_size);
    memory_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  ~Mapped() {
    if (memory_ != MAP_FAILED) ::munmap(memory_, size_);
  }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    if (memory_ == MAP_FAILED) return {};
    return {static_cast<const std::byte*>(memory_), size_};
  }

 private:
  void* memory_ = MAP_FAILED;
  std::size_t size_ = 0;
};

}  // namespace

void sendCells(int file, const Result<std::vector<TimedCells>>& steps, const ReadReport& report) {
  Sender out(file);
  out.one(static_cast<std::uint8_t>(steps.has_value()));
  if (!steps) {
    out.one(steps.error().code);
    out.list(steps.error().message);
    return;
  }
  out.each(*steps, [&](const TimedCells& step) { transferStep(out, step); });
  transferReport(out, report);
}

Result<std::vector<TimedCells>> receiveCells(int file, ReadReport& report) {
  const Mapped mapped(file);
  Receiver in(mapped.bytes());
  std::uint8_t isThere = 0;
  in.one(isThere);
  if (!in.failed() && isThere == 0) {
    Error error;
    in.one(error.code), in.list(error.message);
    error.code = std::min(error.code, ErrorCode::kIo);
    if (!in.failed()) return std::unexpected(error);
  }
  std::vector<TimedCells> steps;
  ReadReport told;
  in.each(steps, [&](TimedCells& step) { transferStep(in, step); });
  transferReport(in, told);
  if (in.failed() || steps.empty())
    return fail(ErrorCode::kBadInput, "what its reader found did not arrive");
  report.ignoredCells += told.ignoredCells;
  report.pieces = told.pieces, report.joinedPoints = told.joinedPoints;
  report.joinedByIds = told.joinedByIds, report.times = std::move(told.times);
  std::ranges::move(told.ignoredFields, std::back_inserter(report.ignoredFields));
  std::ranges::move(told.notes, std::back_inserter(report.notes));
  addBlocks(std::move(told), report);
  return steps;
}

}  // namespace qtet

#include "simplify/read/steps/cell_transfer.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "proto/limits.h"

namespace qtet {
namespace {

class CellTransfer : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_GE(file_ = ::memfd_create("test", MFD_CLOEXEC), 0); }
  void TearDown() override { ::close(file_); }

  int file_ = -1;
};

std::vector<TimedCells> twoSteps() {
  std::vector<TimedCells> out(2);
  for (TimedCells& step : out) {
    step.time = "0.5";
    step.cells.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    step.cells.addCell(kTetrahedronCell, std::vector<VertexId>{0, 1, 2, 3});
    step.cells.cellIds = {7};
    step.cells.pointIds = {4, 5, 6, 1'000'000'000'000};
    step.cells.pointType = "float32";
    step.cells.fields = {{"T", 1, "float64", {1, 2, std::numeric_limits<double>::infinity(), 4}},
                         {"part", 2, "int16", {-1, 3}, "cell", {{-1, "none"}, {3, "a"}}}};
    step.cells.labels = {{"BlockId", {4}, {{4, "fluid"}}}};
    step.cells.otherFields = {"name", ""};
  }
  out[1].cells = {};
  return out;
}

TEST_F(CellTransfer, whatIsSentArrives) {
  const std::vector<TimedCells> sent = twoSteps();
  ReadReport report, got;
  report.ignoredCells = 3, report.pieces = 2, report.joinedPoints = 9;
  report.ignoredFields = {"text"}, report.notes = {"a note"};
  got.ignoredCells = 1, got.notes = {"before"};
  sendCells(file_, sent, report);
  const auto back = receiveCells(file_, got);
  ASSERT_TRUE(back) << back.error().text();
  ASSERT_EQ(back->size(), 2u);
  const CellMesh &a = sent[0].cells, &b = (*back)[0].cells;
  EXPECT_EQ((*back)[0].time, "0.5");
  EXPECT_EQ(b.points, a.points);
  EXPECT_EQ(b.types, a.types);
  EXPECT_EQ(b.begins, a.begins);
  EXPECT_EQ(b.vertices, a.vertices);
  EXPECT_EQ(b.cellIds, a.cellIds);
  EXPECT_EQ(b.pointIds, a.pointIds);
  EXPECT_EQ(b.pointType, a.pointType);
  EXPECT_EQ(b.otherFields, a.otherFields);
  ASSERT_EQ(b.fields.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(b.fields[f].name, a.fields[f].name);
    EXPECT_EQ(b.fields[f].components, a.fields[f].components);
    EXPECT_EQ(b.fields[f].type, a.fields[f].type);
    EXPECT_EQ(b.fields[f].values, a.fields[f].values);
    EXPECT_EQ(b.fields[f].association, a.fields[f].association);
    EXPECT_EQ(b.fields[f].labelNames, a.fields[f].labelNames);
  }
  ASSERT_EQ(b.labels.size(), 1u);
  EXPECT_EQ(b.labels[0].name, "BlockId");
  EXPECT_EQ(b.labels[0].values, a.labels[0].values);
  EXPECT_EQ(b.labels[0].names, a.labels[0].names);
  EXPECT_EQ((*back)[1].cells.cells(), 0u);
  EXPECT_EQ(got.ignoredCells, 4u);
  EXPECT_EQ(got.joinedPoints, 9u);
  EXPECT_EQ(got.notes, (std::vector<std::string>{"before", "a note"}));
}

TEST_F(CellTransfer, anErrorArrives) {
  ReadReport report;
  sendCells(file_, fail(ErrorCode::kNotFound, "no such step"), report);
  const auto back = receiveCells(file_, report);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(back.error().message, "no such step");
}

// The process that wrote them may have been spoilt by the file that it read.
TEST_F(CellTransfer, bytesCutAnywhereAreRefused) {
  ReadReport report;
  sendCells(file_, twoSteps(), report);
  for (off_t size = ::lseek(file_, 0, SEEK_END); size-- > 0;) {
    ASSERT_EQ(::ftruncate(file_, size), 0);
    const auto back = receiveCells(file_, report);
    ASSERT_FALSE(back) << size;
    EXPECT_EQ(back.error().code, ErrorCode::kBadInput);
  }
}

TEST_F(CellTransfer, asManyNamesArriveAsALogHolds) {
  std::vector<TimedCells> sent = twoSteps();
  LabelNames& names = sent[0].cells.labels[0].names;
  for (std::int32_t i = 0; std::cmp_less(i, kMaxLabelNames + 1); ++i) names.emplace(i, "x");
  ReadReport report;
  sendCells(file_, sent, report);
  const auto back = receiveCells(file_, report);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ((*back)[0].cells.labels[0].names.size(), kMaxLabelNames);
}

TEST_F(CellTransfer, moreNamesThanALogHoldsAreRefused) {
  std::vector<TimedCells> sent = twoSteps();
  LabelNames& names = sent[0].cells.labels[0].names;
  for (std::int32_t i = 0; std::cmp_less(i, kMaxLabelNames); ++i) names.emplace(i, "x");
  ReadReport report;
  sendCells(file_, sent, report);
  // the count stands before the first value and its name
  const std::uint64_t count = kMaxLabelNames, more = count + 1;
  std::vector<char> bytes(static_cast<std::size_t>(::lseek(file_, 0, SEEK_END)));
  ASSERT_EQ(::pread(file_, bytes.data(), bytes.size(), 0), std::ssize(bytes));
  const std::string_view all(bytes.data(), bytes.size()),
      known(reinterpret_cast<const char*>(&count), sizeof count);
  const std::size_t at = all.rfind(known);
  ASSERT_NE(at, std::string_view::npos);
  ASSERT_EQ(::pwrite(file_, &more, sizeof more, static_cast<off_t>(at)), std::ssize(known));
  const auto back = receiveCells(file_, report);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, ErrorCode::kBadInput);
}

TEST_F(CellTransfer, lengthsBeyondTheBytesAllocateNothing) {
  ReadReport report;
  sendCells(file_, twoSteps(), report);
  const std::uint64_t huge = ~std::uint64_t{0} / 2;
  for (off_t at = 1; at < 200; ++at) {
    std::uint64_t before = 0;
    ASSERT_EQ(::pread(file_, &before, sizeof before, at), static_cast<ssize_t>(sizeof before));
    ASSERT_EQ(::pwrite(file_, &huge, sizeof huge, at), static_cast<ssize_t>(sizeof huge));
    (void)receiveCells(file_, report);
    ASSERT_EQ(::pwrite(file_, &before, sizeof before, at), static_cast<ssize_t>(sizeof before));
  }
}

}  // namespace
}  // namespace qtet

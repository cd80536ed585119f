// simplify/api/qtet_simplify.h as a C program sees it: logs as the tool makes them, and every wrong
// argument a status with a text.
#include "simplify/api/qtet_simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "codec/coding/number_type.h"
#include "codec/files/atomic_file.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "proto/manifest.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/pipeline/field_meshes.h"
#include "tests/support/block_grid.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

using Made = std::unique_ptr<qtet_simplified, decltype(&qtet_simplified_destroy)>;

Made made() { return {qtet_simplified_create(), &qtet_simplified_destroy}; }

std::string errorOf(const Made& log) { return qtet_simplified_error(log.get()); }

Bytes bytesOf(const Made& log) {
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::uint8_t*>(qtet_simplified_log(log.get(), &bytes));
  return {data, data + bytes};
}

Bytes contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

qtet_simplify_options usual() {
  qtet_simplify_options options;
  EXPECT_EQ(qtet_simplify_defaults(sizeof options, &options), QTET_OK);
  options.source = "mesh.vtu";
  return options;
}

/// A mesh in the arrays that a C program has; everything in its own type.
class Arrays {
 public:
  explicit Arrays(const TetMesh& mesh) : mesh_(mesh) {
    for (const MeshField& field : mesh_.fields) {
      numberType(field.type).append(bytes_.emplace_back(), field.values);
      const auto type = static_cast<std::uint32_t>(std::ranges::find(kFieldTypes, field.type) -
                                                   kFieldTypes.begin() + QTET_FLOAT32);
      fields_.push_back({field.name.c_str(),
                         static_cast<std::uint32_t>(isCellField(field) ? QTET_CELL : QTET_POINT),
                         type, field.components, 0, bytes_.back().data()});
    }
    for (std::size_t f = 0; f < bytes_.size(); ++f) fields_[f].values = bytes_[f].data();
    const bool isFloat = mesh_.pointType == "float32";
    for (const Position& p : mesh_.points)
      numberType(isFloat ? "float32" : "float64").append(points_, p);
    input = {points_.data(),
             mesh_.points.size(),
             mesh_.tetrahedra.data(),
             mesh_.tetrahedra.size(),
             isFloat ? QTET_FLOAT32 : QTET_FLOAT64,
             QTET_UINT32,
             fields_.data(),
             static_cast<std::uint32_t>(fields_.size()),
             sizeof(qtet_input_field)};
  }
  Arrays(const Arrays&) = delete;
  Arrays& operator=(const Arrays&) = delete;

  qtet_input_mesh input{};
  qtet_input_field& field(std::size_t f) { return fields_[f]; }

 private:
  TetMesh mesh_;
  Bytes points_;
  std::vector<Bytes> bytes_;
  std::vector<qtet_input_field> fields_;
};

qtet_status simplified(const Made& log, const Arrays& arrays,
                       const qtet_simplify_options& options = usual()) {
  return qtet_simplify(log.get(), sizeof arrays.input, &arrays.input, sizeof options, &options);
}

TetMesh gridOf(int n) {
  return testing::blockGrid({n, n, n}, [n](int i, int j, int k) {
    return Position{1.0 * i / n, 1.0 * j / n, 1.0 * k / n};
  });
}

/// A mesh of 135 cells. `--measure all` takes a minute for 625 under a sanitizer.
TetMesh smallBox() {
  TetMesh grid = gridOf(3);
  grid.fields.front().name = "Scalar";
  return testing::boxWithFields(std::move(grid));
}

/// The log that the tool makes of the mesh, and the mesh as it reads it.
struct ToolsLog {
  Bytes log;
  TetMesh mesh;
};
ToolsLog toolsLog(const std::string& name, const TetMesh& mesh, const std::string& words) {
  const fs::path folder = testing::freshFolder("c-simplify-" + name);
  EXPECT_TRUE(writeFileAtomically(folder / "mesh.vtu", vtuBytes(mesh)));
  const std::string command = "cd '" + folder.string() + "' && '" + testing::kTool +
                              "' simplify mesh.vtu -o log.qtet -q " + words;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  Result<ReadMesh> read = readMesh(folder / "mesh.vtu");
  EXPECT_TRUE(read);
  return {contentOf(folder / "log.qtet"), std::move(read->mesh)};
}

TEST(QtetSimplify, logsAreTheToolsByteForByte) {
  struct Case {
    const char* words;
    void (*change)(qtet_simplify_options&);
  };
  static const qtet_named_number kWeights[] = {{"Swirl", 3}}, kLabels[] = {{"Label", 40}},
                                 kBounds[] = {{"Scalar", 0.05}};
  static const qtet_error_bound kErrors[] = {{"Scalar", 0.01, nullptr}, {"all", 0.5, "%"}};
  for (const Case& c : {
           Case{"", [](qtet_simplify_options&) {}},
           Case{"--lossless --keep-order --value-codec adaptive --placement vertex --threads 2",
                [](qtet_simplify_options& o) {
                  o.lossless = o.keepOrder = 1;
                  o.valueCodec = QTET_CODEC_ADAPTIVE;
                  o.placement = QTET_PLACEMENT_VERTEX;
                  o.threads = 2;
                }},
           Case{"--algorithm paper --measure none",
                [](qtet_simplify_options& o) {
                  o.algorithm = QTET_ALGORITHM_PAPER;
                  o.measure = QTET_MEASURE_NONE;
                }},
           Case{"--target-ratio 0.2 --boundary-weight 7 --shape-weight 0.1 "
                "--envelope-tolerance 0.02 --position-bits 17 --field-bits 11 "
                "--placement optimal --preserve-regions Label",
                [](qtet_simplify_options& o) {
                  o.targetRatio = 0.2;
                  o.boundaryWeight = 7;
                  o.shapeWeight = 0.1;
                  o.envelopeTolerance = 0.02;
                  o.positionBits = 17;
                  o.fieldBits = 11;
                  o.placement = QTET_PLACEMENT_OPTIMAL;
                  o.regions = "Label";
                }},
           // Few levels: each takes 600,000 samples.
           Case{"--target-ratio 0.9 --measure all",
                [](qtet_simplify_options& o) {
                  o.targetRatio = 0.9;
                  o.measure = QTET_MEASURE_ALL;
                }},
           Case{"--label-weight Label=40",
                [](qtet_simplify_options& o) { o.labelWeights = kLabels, o.labelWeightCount = 1; }},
           Case{"--error Scalar=0.01 --error all=0.5%",
                [](qtet_simplify_options& o) { o.errors = kErrors, o.errorCount = 2; }},
           Case{"--field-weight Swirl=3 --max-boundary-error 0.05 --max-field-error Scalar=0.05",
                [](qtet_simplify_options& o) {
                  o.fieldWeights = kWeights, o.fieldWeightCount = 1;
                  o.maxFieldErrors = kBounds, o.maxFieldErrorCount = 1;
                  o.maxBoundaryError = 0.05;
                }},
       }) {
    const ToolsLog tool = toolsLog("box", smallBox(), c.words);
    const Arrays arrays(tool.mesh);
    qtet_simplify_options options = usual();
    c.change(options);
    const Made log = made();
    ASSERT_EQ(simplified(log, arrays, options), QTET_OK) << errorOf(log);
    EXPECT_EQ(bytesOf(log), tool.log) << c.words;
  }
}

TEST(QtetSimplify, soAreThoseOfALargeMeshAndItsProgressIsTold) {
  const ToolsLog tool = toolsLog("grid", gridOf(20), "--measure none");
  const Arrays arrays(tool.mesh);
  struct Told {
    std::thread::id thread = std::this_thread::get_id();
    std::uint32_t stage = 0;
    double fraction = 0;
    int calls = 0, bad = 0;
  } told;
  qtet_simplify_options options = usual();
  options.measure = QTET_MEASURE_NONE;
  options.user = &told;
  options.progress = [](void* user, std::uint32_t stage, double fraction) {
    Told& t = *static_cast<Told*>(user);
    t.bad += std::this_thread::get_id() != t.thread || stage < t.stage || fraction < 0 ||
             fraction > 1 || (stage == t.stage && fraction < t.fraction);
    t.stage = stage, t.fraction = fraction, ++t.calls;
    return 0;
  };
  const Made log = made();
  ASSERT_EQ(simplified(log, arrays, options), QTET_OK) << errorOf(log);
  EXPECT_EQ(bytesOf(log), tool.log);
  EXPECT_EQ(told.bad, 0);
  EXPECT_GT(told.calls, 3);
}

TEST(QtetSimplify, aCallbackThatSaysSoEndsTheWork) {
  const Arrays arrays(gridOf(20));
  int calls = 0;
  qtet_simplify_options options = usual();
  options.user = &calls;
  options.progress = [](void* user, std::uint32_t, double) {
    return ++*static_cast<int*>(user) == 2 ? 1 : 0;
  };
  const Made log = made();
  EXPECT_EQ(simplified(log, arrays, options), QTET_CANCELLED);
  EXPECT_TRUE(errorOf(log).starts_with("cancelled: ")) << errorOf(log);
  EXPECT_EQ(calls, 2) << "nobody is asked again";
  EXPECT_EQ(qtet_simplified_log(log.get(), nullptr), nullptr);
  const Arrays box(testing::boxWithFields());
  EXPECT_EQ(simplified(log, box), QTET_OK) << "the handle is as good as before";
}

TEST(QtetSimplify, typesOfNumbersDoNotMatterWhereTheyHoldTheSame) {
  const TetMesh mesh = boxSample();  // coordinates of 1/8, which a float holds
  Arrays arrays(mesh);
  const Made log = made();
  ASSERT_EQ(simplified(log, arrays), QTET_OK) << errorOf(log);
  const Bytes expected = bytesOf(log);
  std::vector<float> points;
  for (const Position& p : mesh.points)
    for (const double x : p) points.push_back(static_cast<float>(x));
  arrays.input.points = points.data(), arrays.input.pointType = QTET_FLOAT32;
  std::vector<std::int64_t> wide;
  std::vector<std::int32_t> narrow;
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (const VertexId v : cell) wide.push_back(v), narrow.push_back(static_cast<int>(v));
  for (const auto& [ids, type] : {std::pair{static_cast<const void*>(wide.data()), QTET_INT64},
                                  {wide.data(), QTET_UINT64},
                                  {narrow.data(), QTET_INT32},
                                  {narrow.data(), QTET_UINT32}}) {
    arrays.input.tetrahedra = ids, arrays.input.idType = static_cast<std::uint32_t>(type);
    ASSERT_EQ(simplified(log, arrays), QTET_OK) << errorOf(log);
    EXPECT_EQ(bytesOf(log), expected);
  }
}

TEST(QtetSimplify, whatIsLeftOutIsTheDefault) {
  const Arrays arrays(testing::boxWithFields());
  const Made log = made();
  ASSERT_EQ(qtet_simplify(log.get(), sizeof arrays.input, &arrays.input, 0, nullptr), QTET_OK);
  const Bytes expected = bytesOf(log);
  struct Longer {
    qtet_simplify_options options;
    char later[64];
  } longer;
  ASSERT_EQ(qtet_simplify_defaults(sizeof longer, &longer.options), QTET_OK);
  EXPECT_TRUE(std::ranges::all_of(longer.later, [](char c) { return c == 0; }));
  std::ranges::fill(longer.later, 'x');
  ASSERT_EQ(
      qtet_simplify(log.get(), sizeof arrays.input, &arrays.input, sizeof longer, &longer.options),
      QTET_OK);
  EXPECT_EQ(bytesOf(log), expected);
}

TEST(QtetSimplify, originalIdsAreKeptForTheLastLevelAlone) {
  TetMesh mesh = testing::boxWithFields();
  MeshField ids{"OriginalCellId", 1, "int32", {}, "cell"};
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::size_t cube = t / 6;
    ids.values.push_back(static_cast<double>(cube));
  }
  mesh.fields.push_back(ids);
  const Arrays arrays(mesh);
  const Made log = made();
  const auto closingKinds = [&] {
    const LogIndex index = LogIndex::parse(bytesOf(log)).value();
    std::vector<std::uint32_t> out;
    for (const ClosingBlock& c : index.closing) out.push_back(static_cast<std::uint32_t>(c.kind));
    return out;
  };
  ASSERT_EQ(simplified(log, arrays), QTET_OK) << errorOf(log);
  EXPECT_EQ(LogIndex::parse(bytesOf(log)).value().fields.size(), mesh.fields.size());
  EXPECT_TRUE(closingKinds().empty());
  qtet_simplify_options options = usual();
  options.originalIds = 1;
  ASSERT_EQ(simplified(log, arrays, options), QTET_OK) << errorOf(log);
  EXPECT_EQ(LogIndex::parse(bytesOf(log)).value().fields.size(), mesh.fields.size() - 1);
  EXPECT_EQ(closingKinds(), (std::vector<std::uint32_t>{1, 2, 5}));
}

TEST(QtetSimplify, aSeriesGivesItsStatisticsOnDemand) {
  TetMesh mesh = testing::boxWithFields();
  mesh.fields.push_back(mesh.fields[0]);
  mesh.fields[0].name = "T@0", mesh.fields.back().name = "T@1";
  const Made log = made();
  qtet_simplify_options options = usual();
  options.timeStatistics = 1;
  ASSERT_EQ(simplified(log, Arrays(mesh), options), QTET_OK) << errorOf(log);
  EXPECT_EQ(LogIndex::parse(bytesOf(log)).value().fields.size(), mesh.fields.size() + 4);
  options.timeStatistics = 2;
  EXPECT_EQ(simplified(log, Arrays(mesh), options), QTET_BAD_VALUE);
  options.timeStatistics = 0, options.labelWeightCount = 1;
  EXPECT_EQ(simplified(log, Arrays(mesh), options), QTET_BAD_VALUE);
}

TEST(QtetSimplify, theBaseMeshHasAsManyCellsAsAreAskedFor) {
  const Arrays arrays(testing::boxWithFields());
  const Made log = made();
  const auto baseOf = [&](const qtet_simplify_options& options) {
    EXPECT_EQ(simplified(log, arrays, options), QTET_OK) << errorOf(log);
    return manifestOf(LogIndex::parse(bytesOf(log)).value())->levels.front().tetrahedra;
  };
  qtet_simplify_options options = usual();
  EXPECT_TRUE(std::isnan(options.targetRatio));
  options.baseCells = 200;
  const auto base = baseOf(options);
  EXPECT_LE(base, 200u);
  EXPECT_GT(base, 150u);
  options.targetRatio = 0.5;
  EXPECT_EQ(simplified(log, arrays, options), QTET_BAD_INPUT) << "one of the two";
  options.baseCells = 0;
  EXPECT_GT(baseOf(options), 200u);

  options = usual();
  EXPECT_TRUE(std::isnan(options.baseError));
  options.targetRatio = 0.01;
  EXPECT_LT(baseOf(options), 35u);
  options.baseError = 0.001;
  EXPECT_GT(baseOf(options), 35u) << "so few cells fill no box";
  options.baseError = -1;
  EXPECT_EQ(simplified(log, arrays, options), QTET_BAD_VALUE);
}

TEST(QtetSimplify, theLogIsOpenedFromMemoryAndWrittenAsAFile) {
  TetMesh mesh = testing::boxWithFields();
  std::swap(mesh.tetrahedra[3][0], mesh.tetrahedra[3][1]);
  const Arrays arrays(mesh);
  const Made log = made();
  EXPECT_EQ(qtet_simplified_write(log.get(), "log.qtet"), QTET_NO_LOG);
  qtet_simplify_options options = usual();
  options.targetRatio = 0.001;  // three cells, which fill no box
  ASSERT_EQ(simplified(log, arrays, options), QTET_OK) << errorOf(log);
  const std::string notes = qtet_simplified_notes(log.get());
  EXPECT_TRUE(notes.starts_with("cells turned to the orientation of VTK: 1 (cell 3)\n")) << notes;
  EXPECT_NE(notes.find("\nwarning: the base mesh has lost "), std::string::npos) << notes;
  std::size_t bytes = 0;
  const void* data = qtet_simplified_log(log.get(), &bytes);
  const std::unique_ptr<qtet_log, decltype(&qtet_log_destroy)> reader(qtet_log_create(),
                                                                      &qtet_log_destroy);
  ASSERT_EQ(qtet_log_open_memory(reader.get(), bytes, data), QTET_OK);
  ASSERT_EQ(qtet_log_refine(reader.get(), QTET_FULL), QTET_OK);
  EXPECT_EQ(qtet_log_tetrahedron_count(reader.get()), kBoxCells);

  const fs::path folder = testing::freshFolder("c-simplify-write");
  EXPECT_EQ(qtet_simplified_write(log.get(), (folder / "no" / "log.qtet").c_str()), QTET_NOT_FOUND);
  ASSERT_EQ(qtet_simplified_write(log.get(), (folder / "log.qtet").c_str()), QTET_OK);
  EXPECT_EQ(contentOf(folder / "log.qtet"), bytesOf(log));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "nothing is left beside it";
}

TEST(QtetSimplify, noExceptionAndNoCrashWhateverIsGiven) {
  const auto refused = [](qtet_status status, const std::string& words,
                          const std::function<void(Arrays&, qtet_simplify_options&)>& change) {
    Arrays arrays(smallBox());
    qtet_simplify_options options = usual();
    const Made log = made();
    ASSERT_EQ(simplified(log, arrays, options), QTET_OK);
    change(arrays, options);
    EXPECT_EQ(simplified(log, arrays, options), status) << words << ": " << errorOf(log);
    EXPECT_TRUE(errorOf(log).starts_with(std::string(qtet_status_name(status)) + ": "))
        << errorOf(log);
    EXPECT_NE(errorOf(log).find(words), std::string::npos) << errorOf(log);
    std::size_t bytes = 7;
    EXPECT_EQ(qtet_simplified_log(log.get(), &bytes), nullptr) << "the log before is gone";
    EXPECT_EQ(bytes, 0u);
  };
  using O = qtet_simplify_options;
  refused(QTET_BAD_INPUT, "null", [](Arrays& a, O&) { a.input.points = nullptr; });
  refused(QTET_BAD_INPUT, "null", [](Arrays& a, O&) { a.input.tetrahedra = nullptr; });
  refused(QTET_BAD_INPUT, "null", [](Arrays& a, O&) { a.input.fields = nullptr; });
  refused(QTET_BAD_INPUT, "no points", [](Arrays& a, O&) { a.input.pointCount = 0; });
  refused(QTET_BAD_INPUT, "no tetrahedra", [](Arrays& a, O&) { a.input.tetrahedronCount = 0; });
  refused(QTET_BAD_INPUT, "outside the 60", [](Arrays& a, O&) { a.input.pointCount = 60; });
  refused(QTET_LIMIT_EXCEEDED, "2^29",
          [](Arrays& a, O&) { a.input.pointCount = std::uint64_t{1} << 60; });
  refused(QTET_LIMIT_EXCEEDED, "2^29",
          [](Arrays& a, O&) { a.input.tetrahedronCount = ~std::uint64_t{0}; });
  refused(QTET_LIMIT_EXCEEDED, "8192 fields", [](Arrays& a, O&) { a.input.fieldCount = 8193; });
  refused(QTET_BAD_INPUT, "points are of type 5",
          [](Arrays& a, O&) { a.input.pointType = QTET_INT32; });
  refused(QTET_BAD_INPUT, "tetrahedra are of type 1",
          [](Arrays& a, O&) { a.input.idType = QTET_FLOAT32; });
  refused(QTET_BAD_INPUT, "sizeof(qtet_input_field)",
          [](Arrays& a, O&) { a.input.fieldBytes = 8; });
  refused(QTET_BAD_INPUT, "field 2", [](Arrays& a, O&) { a.field(2).name = nullptr; });
  refused(QTET_BAD_INPUT, "field 2", [](Arrays& a, O&) { a.field(2).values = nullptr; });
  refused(QTET_BAD_INPUT, "association 2", [](Arrays& a, O&) { a.field(2).association = 2; });
  refused(QTET_BAD_INPUT, "type 11", [](Arrays& a, O&) { a.field(2).type = 11; });
  refused(QTET_BAD_INPUT, "type 0", [](Arrays& a, O&) { a.field(2).type = 0; });
  refused(QTET_BAD_INPUT, "17 components", [](Arrays& a, O&) { a.field(2).components = 17; });
  refused(QTET_BAD_INPUT, "0 components", [](Arrays& a, O&) { a.field(2).components = 0; });
  refused(QTET_BAD_INPUT, "called Swirl", [](Arrays& a, O&) { a.field(0).name = "Swirl"; });
  refused(QTET_BAD_VALUE, "algorithm is 2", [](Arrays&, O& o) { o.algorithm = 2; });
  refused(QTET_BAD_VALUE, "placement is 3", [](Arrays&, O& o) { o.placement = 3; });
  refused(QTET_BAD_VALUE, "measure is 3", [](Arrays&, O& o) { o.measure = 3; });
  refused(QTET_BAD_VALUE, "valueCodec is 3", [](Arrays&, O& o) { o.valueCodec = 3; });
  refused(QTET_BAD_VALUE, "keepOrder is 2", [](Arrays&, O& o) { o.keepOrder = 2; });
  refused(QTET_BAD_VALUE, "originalIds is 2", [](Arrays&, O& o) { o.originalIds = 2; });
  refused(QTET_BAD_VALUE, "lossless is 2", [](Arrays&, O& o) { o.lossless = 2; });
  refused(QTET_BAD_VALUE, "position bits", [](Arrays&, O& o) { o.positionBits = ~0u; });
  refused(QTET_BAD_VALUE, "field bits", [](Arrays&, O& o) { o.fieldBits = 0; });
  refused(QTET_BAD_VALUE, "exactCoarse is 2", [](Arrays&, O& o) { o.exactCoarse = 2; });
  refused(QTET_BAD_INPUT, "0..1", [](Arrays&, O& o) { o.targetRatio = INFINITY; });
  refused(QTET_BAD_INPUT, "weights", [](Arrays&, O& o) { o.shapeWeight = NAN; });
  refused(QTET_BAD_INPUT, "tolerance", [](Arrays&, O& o) { o.envelopeTolerance = -1; });
  refused(QTET_BAD_VALUE, "needs measuring",
          [](Arrays&, O& o) { o.measure = QTET_MEASURE_NONE, o.maxBoundaryError = 0.1; });
  refused(QTET_BAD_VALUE, "fieldWeights is null", [](Arrays&, O& o) { o.fieldWeightCount = 1; });
  static const qtet_named_number kNoName{nullptr, 1}, kNoNumber{"Swirl", NAN}, kNoField{"?", 1};
  refused(QTET_BAD_VALUE, "maxFieldErrors[0]",
          [](Arrays&, O& o) { o.maxFieldErrors = &kNoName, o.maxFieldErrorCount = 1; });
  refused(QTET_BAD_VALUE, "fieldWeights[0]",
          [](Arrays&, O& o) { o.fieldWeights = &kNoNumber, o.fieldWeightCount = 1; });
  refused(QTET_NOT_FOUND, "'?'",
          [](Arrays&, O& o) { o.fieldWeights = &kNoField, o.fieldWeightCount = 1; });
  refused(QTET_BAD_VALUE, "labelWeights is null", [](Arrays&, O& o) { o.labelWeightCount = 1; });
  refused(QTET_NOT_FOUND, "'?'",
          [](Arrays&, O& o) { o.labelWeights = &kNoField, o.labelWeightCount = 1; });
  refused(QTET_BAD_VALUE, "errors is null", [](Arrays&, O& o) { o.errorCount = 1; });
  static const qtet_error_bound kUnnamed{nullptr, 1, ""}, kZero{"Swirl", 0, ""},
      kOfNone{"?", 1, ""}, kInMetres{"Swirl", 1, "m"};
  const auto refusedBound = [&](qtet_status status, const char* words,
                                const qtet_error_bound& bound) {
    refused(status, words, [&](Arrays&, O& o) { o.errors = &bound, o.errorCount = 1; });
  };
  refusedBound(QTET_BAD_VALUE, "errors[0] has no name", kUnnamed);
  refusedBound(QTET_BAD_VALUE, "above 0", kZero);
  refusedBound(QTET_NOT_FOUND, "'?'", kOfNone);
  refusedBound(QTET_BAD_VALUE, "no unit that is known", kInMetres);
  refused(QTET_BAD_VALUE, "finest", [](Arrays&, O& o) { o.finest = 1, o.lossless = 1; });
  refused(QTET_NOT_FOUND, "'?'", [](Arrays&, O& o) { o.regions = "?"; });
}

TEST(QtetSimplify, aNullHandleOrStructIsRefused) {
  // ends within the last member that the first version had; later ones may be missing
  constexpr std::size_t kLastOfFirst = offsetof(qtet_simplify_options, user) + 1;
  const Arrays arrays(boxSample());
  const Made log = made();
  const qtet_simplify_options options = usual();
  const qtet_input_mesh& mesh = arrays.input;
  EXPECT_EQ(qtet_simplify(nullptr, sizeof mesh, &mesh, 0, nullptr), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_simplify(log.get(), sizeof mesh, nullptr, 0, nullptr), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_simplify(log.get(), sizeof mesh - 1, &mesh, 0, nullptr), QTET_BAD_ARGUMENT);
  EXPECT_NE(errorOf(log).find("pass sizeof"), std::string::npos);
  EXPECT_EQ(qtet_simplify(log.get(), sizeof mesh, &mesh, kLastOfFirst, &options),
            QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_simplify_defaults(sizeof options, nullptr), QTET_BAD_ARGUMENT);
  qtet_simplify_options none{};
  EXPECT_EQ(qtet_simplify_defaults(kLastOfFirst, &none), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_simplified_write(nullptr, "log.qtet"), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_simplified_write(log.get(), nullptr), QTET_BAD_ARGUMENT);
  EXPECT_STREQ(qtet_simplified_error(nullptr), "bad-argument: the place for the log is null");
  EXPECT_STREQ(qtet_simplified_notes(nullptr), "");
  EXPECT_EQ(qtet_simplified_log(nullptr, nullptr), nullptr);
  qtet_simplified_destroy(nullptr);
}

}  // namespace
}  // namespace qtet

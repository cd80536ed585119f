// Compares the memory of decoding with its prediction, and checks that decoding stops on request.
#include "codec/log/decoding_memory.h"

#include <gtest/gtest.h>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/refine/log_file.h"
#include "codec/refine/verify_log.h"
#include "proto/limits.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

void compare(const LogFile& log, const std::string& what, double maxTimes) {
  const Result<Manifest> manifest = manifestOf(log.index());
  ASSERT_TRUE(manifest) << what;
  const auto foretold = static_cast<double>(decodingBytes(log.index()));
  const auto taken = static_cast<double>(testing::peakBytesOf([&] {
    const Result<Refiner> decoded = decodeVerified(log, *manifest, {}, Verified::kFields);
    ASSERT_TRUE(decoded) << what << decoded.error().text();
  }));
  EXPECT_LE(taken, foretold) << what;
  EXPECT_LE(foretold, maxTimes * taken) << what;
}

TEST(DecodingBytes, areAtLeastWhatDecodingTakesAndNotFarFromIt) {
  for (const bool cellFields : {false, true})
    for (const double ratio : {0.0, 0.5, 1.0}) {
      LatticeMesh mesh = testing::soundMesh(14, 1);
      if (cellFields) testing::addCellFields(mesh);
      FusionOptions options;
      options.targetRatio = ratio;
      const auto history = simplify(mesh, options);
      ASSERT_TRUE(history) << history.error().text();
      auto log = encodeLog(*history, {});
      ASSERT_TRUE(log) << log.error().text();
      const std::string what = (cellFields ? "with cell fields, " : "") + std::to_string(ratio);
      compare(LogFile::fromBytes(std::move(log->bytes)).value(), what, 2.5);
    }
}

TEST(DecodingBytes, areEnoughForEveryGoldenLog) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(testing::kGoldenFolder) / "valid"))
    if (entry.path().extension() == ".qtet")
      compare(LogFile::open(entry.path()).value(), entry.path().filename(), 1e9);
}

/// The predicted bytes for a table with a base mesh only, whose structure has so many bytes.
std::uint64_t bytesOfBase(std::uint32_t structureBytes, std::uint32_t elements,
                          std::uint32_t fieldComponents = 0) {
  LogIndex index;
  index.chunks.resize(1);
  if (fieldComponents > 0) index.fields.push_back({fieldComponents});
  index.chunks[0].blocks.resize(index.parts());
  index.chunks[0].blocks[kStructurePart].size = structureBytes;
  index.chunks[0].newVertices = index.chunks[0].newTetrahedra =
      index.chunks[0].newBoundaryTriangles = elements;
  return decodingBytes(index);
}

TEST(DecodingBytes, countAMeshThriceWhereItsBytesAreTooFewToMakeRoomForIt) {
  constexpr std::uint32_t kBytes = 1000, kMax = kMaxElementsPerByte * kBytes;
  for (const std::uint32_t elements : {kMax - 1, kMax, kMax + 1}) {
    const std::uint64_t roomy = bytesOfBase(2 * kBytes, elements);
    const std::uint64_t grown = elements > kMax ? 2 : 0;
    EXPECT_EQ(bytesOfBase(kBytes, elements),
              roomy + grown * GrowingMesh::roomFor({elements, elements, elements}))
        << elements;
  }
}

TEST(DecodingBytes, countAFieldsIntegersThriceAndItsBlock) {
  constexpr std::uint32_t kVertices = 100;
  constexpr std::uint64_t kBlockInteger = 24;
  EXPECT_EQ(bytesOfBase(1000, kVertices, 3) - bytesOfBase(1000, kVertices, 2),
            kVertices * (3 * sizeof(std::int32_t) + kBlockInteger));
}

// The base mesh and a level of one chunk each, so that whoever asks for the end is asked in the
// midst of a chunk.
TEST(DecodeVerified, endsBeforeTheNextLevelWhereNobodyWaits) {
  const auto history = simplify(testing::soundMesh(5, 1), {});
  ASSERT_TRUE(history) << history.error().text();
  auto encoded = encodeLog(*history, {});
  ASSERT_TRUE(encoded) << encoded.error().text();
  const LogFile log = LogFile::fromBytes(std::move(encoded->bytes)).value();
  const Manifest manifest = manifestOf(log.index()).value();
  int asked = 0;
  ASSERT_TRUE(decodeVerified(log, manifest, [&](double) { return ++asked, true; }));
  ASSERT_GT(static_cast<std::size_t>(asked), log.index().chunks.size()) << "also within chunks";
  for (int most = 0; most < asked; ++most) {
    int left = most;
    const Result<Refiner> decoded =
        decodeVerified(log, manifest, [&](double) { return left-- > 0; });
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::kIo);
    EXPECT_EQ(left, -1) << "it was asked again";
  }
}

TEST(DecodeVerified, forgetsFieldsThatNobodyAsksFor) {
  LatticeMesh mesh = testing::soundMesh(8, 1);
  for (int copy = 0; copy < 40; ++copy)
    mesh.fields.push_back(mesh.fields[1]), mesh.values.push_back(mesh.values[1]),
        mesh.fields.back().name = mesh.fields.back().name + std::to_string(copy);
  const auto encoded = encodeLog(simplify(mesh, {}).value(), {});
  ASSERT_TRUE(encoded) << encoded.error().text();
  const LogFile log = LogFile::fromBytes(encoded->bytes).value();
  const Manifest manifest = manifestOf(log.index()).value();
  const auto peakOf = [&](Verified left) {
    return testing::peakBytesOf([&] {
      const Result<Refiner> decoded = decodeVerified(log, manifest, {}, left);
      ASSERT_TRUE(decoded) << decoded.error().text();
      EXPECT_EQ(decoded->fieldValues(5).empty(), left == Verified::kMesh);
    });
  };
  const std::size_t bytesOfFields = 40 * mesh.values[1].size() * sizeof(std::int32_t);
  EXPECT_LT(peakOf(Verified::kMesh), peakOf(Verified::kFields) - bytesOfFields / 2);
}

TEST(DecodeVerified, aFieldsIntegersLieWithinTheBitsThatTheManifestSays) {
  constexpr int kBits = 7;
  constexpr std::int32_t kEnd = 1 << kBits;
  for (const std::int32_t integer : {-1, 0, kEnd - 1, kEnd, kEnd + 1}) {
    LatticeMesh mesh = testing::soundMesh(2, 1);
    for (std::int32_t& value : mesh.values[0]) value %= kEnd / 2;
    mesh.values[0][0] = integer;
    mesh.fields[0].bits = kBits;
    const Result<EncodedLog> encoded = encodeLog(simplify(mesh, {}).value(), {});
    ASSERT_TRUE(encoded) << encoded.error().text();
    const LogFile log = LogFile::fromBytes(encoded->bytes).value();
    const Result<Refiner> decoded = decodeVerified(log, manifestOf(log.index()).value());
    ASSERT_EQ(decoded.has_value(), 0 <= integer && integer < kEnd) << integer;
    if (decoded) continue;
    EXPECT_EQ(decoded.error().code, ErrorCode::kBadValue);
    EXPECT_NE(decoded.error().message.find("the integer " + std::to_string(integer) + ","),
              std::string::npos)
        << decoded.error().text();
  }
}

}  // namespace
}  // namespace qtet

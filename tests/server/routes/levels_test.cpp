// Levels of a real log through a real server: what comes is the level that the manifest promises.
#include "tests/support/sample_log.h"

#include <draco/compression/decode.h>
#include <gtest/gtest.h>

#include "codec/files/mesh_file.h"
#include "tests/server/program/loopback.h"

namespace qtet {
namespace {

class SampleServer : public ::testing::Test {
 protected:
  static Result<MeshStore> openSample() {
    return MeshStore::open(qtet::testing::sampleLog().parent_path());
  }

  Result<MeshStore> store_ = openSample();
  ViewerFiles viewer_;
};

TEST_F(SampleServer, thePosterIsASmallPictureThatCachesMayKeep) {
  ASSERT_TRUE(store_) << store_.error().message;
  const MeshPointer mesh = store_->catalogue()->meshes.begin()->get()->open();
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  const auto poster = client.get("/v1/logs/" + mesh->log.digest() + "/poster.webp");
  ASSERT_EQ(poster.status, 200u) << poster.body;
  EXPECT_EQ(poster.header("content-type"), "image/webp");
  EXPECT_NE(poster.header("cache-control").find("immutable"), std::string::npos);
  EXPECT_EQ(poster.body.substr(8, 4), "WEBP");
  EXPECT_LE(poster.body.size(), 6000u);
}

TEST_F(SampleServer, everyLevelIsServedAsEveryKindOfFile) {
  ASSERT_TRUE(store_) << store_.error().message;
  const CataloguePointer catalogue = store_->catalogue();
  ASSERT_EQ(catalogue->meshes.size(), 1u);
  const MeshPointer sample = catalogue->meshes.begin()->get()->open();
  const ServedMesh& mesh = *sample;
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  for (const ManifestLevel& level : mesh.manifest.levels) {
    const std::string path =
        "/v1/logs/" + mesh.log.digest() + "/levels/" + std::to_string(level.level);
    const auto vtu = client.get(path + ".vtu");
    ASSERT_EQ(vtu.status, 200u) << vtu.body;
    EXPECT_NE(vtu.body.find("NumberOfPoints=\"" + std::to_string(level.vertices) + "\""),
              std::string::npos);
    EXPECT_NE(vtu.body.find("NumberOfCells=\"" + std::to_string(level.tetrahedra) + "\""),
              std::string::npos);

    const auto drc = client.get(path + ".drc");
    ASSERT_EQ(drc.status, 200u) << drc.body;
    draco::DecoderBuffer buffer;
    buffer.Init(drc.body.data(), drc.body.size());
    draco::Decoder decoder;
    const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    ASSERT_TRUE(decoded.ok()) << decoded.status().error_msg();
    EXPECT_EQ(decoded.value()->num_faces(), level.boundaryTriangles);
    EXPECT_EQ(decoded.value()->num_attributes(), 1 + static_cast<int>(mesh.manifest.fields.size()));

    const auto glb = client.get(path + ".glb?fields=");
    ASSERT_EQ(glb.status, 200u) << glb.body;
    EXPECT_TRUE(glb.body.starts_with("glTF"));
    for (const std::string ending : {".vtk", ".msh", ".obj", ".usda"}) {
      const Result<LatticeMesh> bare =
          meshAtLevel(mesh.log, level.level, std::vector<std::uint32_t>{});
      ASSERT_TRUE(bare);
      const Result<Bytes> wanted = meshFileBytes(*bare, ending);
      ASSERT_TRUE(wanted);
      const auto served = client.get(path + ending + "?fields=");
      ASSERT_EQ(served.status, 200u) << ending << served.body;
      EXPECT_TRUE(std::ranges::equal(served.body, *wanted, {}, [](char c) {
        return static_cast<std::uint8_t>(c);
      })) << ending;
    }
    EXPECT_NE(glb.body.find(R"("count":)" + std::to_string(3 * level.boundaryTriangles)),
              std::string::npos);
  }
}

}  // namespace
}  // namespace qtet

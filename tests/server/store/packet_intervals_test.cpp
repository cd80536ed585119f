// Which packets an isosurface meets, of real logs, and what a stream makes of it.
#include "server/store/packet_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "codec/log/log_manifest.h"
#include "codec/refine/refiner.h"
#include "server/stream/client_blocks.h"
#include "server/stream/planner.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

/// A block of 3,000 cells in packets of 60 or so. The field rises along x, the other one turns.
LatticeMesh slopeMesh() {
  LatticeMesh mesh = testing::gridMesh(8, 3);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    mesh.values[0][v] = mesh.points[v][0] + mesh.points[v][1] / 8;
    for (std::size_t c = 0; c < 3; ++c) mesh.values[1][3 * v + c] = mesh.points[v][c];
  }
  return mesh;
}

void writeSlope(const std::filesystem::path& path) {
  FusionOptions fusion;
  fusion.targetRatio = 0.02;
  fusion.bands.cellsPerPacket = 60;
  testing::writeLog(path, slopeMesh(), fusion);
}

class PacketIntervalsTest : public ::testing::Test {
 protected:
  PacketIntervalsTest() {
    writeSlope(folder_.path() / "slope.qtet");
    log_ = std::make_unique<LogFile>(LogFile::open(folder_.path() / "slope.qtet").value());
    manifest_ = manifestOf(index()).value();
    table_ = packetIntervals(*log_, manifest_).value();
  }
  [[nodiscard]] const LogIndex& index() const { return log_->index(); }
  [[nodiscard]] std::vector<std::uint32_t> planned(const Isovalue& isovalue) const {
    const StopAt stop =
        chunksFor(LevelTarget{manifest_.levels.back().level}, manifest_, index()).value();
    std::vector<std::uint32_t> out;
    for (const BlockRun& run :
         planStream({index(), manifest_, &table_}, ClientBlocks(index(), {0, 1}),
                    {.isovalue = isovalue}, stop, ~0u))
      out.push_back(run.chunk);
    return out;
  }
  using Cell = std::array<LatticePoint, 4>;
  /// The cells of the mesh of these chunks that the isosurface meets, by their places. `valueOf`:
  /// of a vertex.
  template <class ValueOf>
  [[nodiscard]] std::set<Cell> met(const std::vector<std::uint32_t>& chunks, double isovalue,
                                   const ValueOf& valueOf) const {
    Refiner refiner(index());
    const std::vector<std::uint32_t> fields = {0, 1};
    for (const std::uint32_t chunk : chunks) EXPECT_TRUE(applyChunk(*log_, refiner, chunk, fields));
    std::set<Cell> out;
    for (const Tetrahedron& t : refiner.tetrahedra()) {
      if (t == kHoleTetrahedron) continue;
      ValueInterval interval;
      Cell cell;
      for (std::size_t i = 0; i < 4; ++i) {
        cell[i] = refiner.points()[t[i]];
        const double value = valueOf(refiner, t[i]);
        interval.add({value, value});
      }
      std::ranges::sort(cell);
      if (interval.holds(isovalue)) out.insert(cell);
    }
    return out;
  }
  [[nodiscard]] std::vector<std::uint32_t> allChunks() const {
    std::vector<std::uint32_t> out(index().chunks.size());
    for (std::uint32_t c = 0; c < out.size(); ++c) out[c] = c;
    return out;
  }

  test::TempFolder folder_;
  std::unique_ptr<LogFile> log_;
  Manifest manifest_;
  PacketIntervals table_;
};

TEST_F(PacketIntervalsTest,
       theIsosurfaceIsThatOfTheFinestMeshAsSoonAsThePacketsThatItMeetsAreHere) {
  ASSERT_GT(index().chunks.size(), index().headChunks() + 20);
  const auto height = [&](const Refiner& refiner, VertexId v) {
    return manifest_.fields[0].minimum[0] + manifest_.fields[0].step * refiner.fieldValues(0)[v];
  };
  std::size_t saved = 0;
  for (double value = manifest_.fields[0].range[0]; value < manifest_.fields[0].range[1];
       value += 17.3) {
    const auto chunks = planned({"Height", {}, {value}});
    EXPECT_EQ(met(chunks, value, height), met(allChunks(), value, height)) << value;
    saved += index().chunks.size() - chunks.size();
  }
  EXPECT_GT(saved, 0u);
  const auto middle =
      planned({"Height", {}, {(manifest_.fields[0].range[0] + manifest_.fields[0].range[1]) / 2}});
  EXPECT_LT(middle.size(), index().chunks.size() * 3 / 4)
      << "a plane through the middle does not need everything";
  EXPECT_EQ(planned({"Height", {}, {1e9}}).size(), index().headChunks());
}

TEST_F(PacketIntervalsTest, ofSeveralComponentsTheLengthCountsOrTheOneThatIsNamed) {
  const ManifestField& field = manifest_.fields[1];
  const auto component = [&](std::size_t c) {
    return [&, c](const Refiner& refiner, VertexId v) {
      return field.minimum[c] + field.step * refiner.fieldValues(1)[3 * v + c];
    };
  };
  const auto length = [&](const Refiner& refiner, VertexId v) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) square += std::pow(component(c)(refiner, v), 2);
    return std::sqrt(square);
  };
  for (const double value : {20.0, 60.0, 110.0}) {
    EXPECT_EQ(met(planned({"Swirl", {}, {value}}), value, length), met(allChunks(), value, length))
        << value;
    for (const std::uint32_t c : {0u, 2u})
      EXPECT_EQ(met(planned({"Swirl", c, {value}}), value, component(c)),
                met(allChunks(), value, component(c)))
          << value << " of component " << c;
  }
  EXPECT_NE(planned({"Swirl", 0, {20}}), planned({"Swirl", 2, {20}}));
}

TEST_F(PacketIntervalsTest, aParentHoldsWhatItsChildrenHold) {
  const std::size_t column = table_.columnOf(manifest_, {"Height", {}, {}}).value();
  for (std::uint32_t chunk = index().headChunks(); chunk < index().chunks.size(); ++chunk) {
    const ValueInterval& own = table_.of(chunk, column);
    if (index().chunks[chunk].records == 0) continue;  // nothing to refine below its parent
    EXPECT_LE(own.least, own.most) << chunk;
    const std::uint32_t parent = index().dependencies[index().chunks[chunk].firstDependency];
    if (index().chunks[parent].node == 0) continue;
    EXPECT_TRUE(table_.of(parent, column).holds(own.least) &&
                table_.of(parent, column).holds(own.most))
        << chunk;
  }
}

TEST_F(PacketIntervalsTest, whatIsKeptIsReadBackAndAnythingElseTellsNothing) {
  const Isovalue height{"Height", {}, {}};
  const Bytes kept = table_.encode();
  EXPECT_EQ(PacketIntervals::decode(kept, index(), manifest_).encode(), kept);
  const auto again = PacketIntervals::decode(kept, index(), manifest_);
  const auto column = again.columnOf(manifest_, height);
  ASSERT_TRUE(column);
  for (std::uint32_t chunk = 0; chunk < index().chunks.size(); ++chunk)
    EXPECT_EQ(again.of(chunk, *column), table_.of(chunk, *column));
  for (const std::size_t bytes : {std::size_t{0}, kept.size() - 1})
    EXPECT_FALSE(PacketIntervals::decode(ByteView(kept).first(bytes), index(), manifest_)
                     .columnOf(manifest_, height));
}

TEST_F(PacketIntervalsTest, whoIsToldToStopStops) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(packetIntervals(*log_, manifest_, stop.get_token()).error().code, ErrorCode::kIo);
}

TEST(PacketIntervals, ofCellsThereAreNone) {
  const LogFile log =
      LogFile::open(std::filesystem::path(testing::kGoldenFolder) / "valid/cell-fields.qtet")
          .value();
  const Manifest manifest = manifestOf(log.index()).value();
  const PacketIntervals table = packetIntervals(log, manifest).value();
  for (std::size_t f = 0; f < manifest.fields.size(); ++f)
    EXPECT_EQ(table.columnOf(manifest, {fieldKey(manifest, f), {}, {}}).has_value(),
              manifest.fields[f].association == "point")
        << fieldKey(manifest, f);
}

/// A server whose threads for levels wait until they are let go.
class IsovalueStreamTest : public ::testing::Test {
 protected:
  IsovalueStreamTest() {
    writeSlope(folder_.path() / "slope.qtet");
    store_ = *MeshStore::open(folder_.path());
    server_.emplace(store_, files_.viewer(),
                    ServerOptions{.threads = 2,
                                  .makeLevel = [this](const LevelRequest& request,
                                                      const std::stop_token& stop) {
                                    ++jobs_;
                                    while (!go_ && !stop.stop_requested())
                                      std::this_thread::yield();
                                    return makeLevel(request, stop);
                                  }});
  }
  [[nodiscard]] std::string open(const std::string& more) const {
    return R"({"type":"open","mesh":"slope","fields":["Height"],"target":{"level":4000},"credit":9007199254740991)" +
           more + "}";
  }
  static constexpr const char* kView = R"({"isovalue":{"field":"Height","values":[30]}})";
  /// Everything up to `done`: the chunks that came.
  static std::set<std::uint32_t> chunks(test::StreamClient& client) {
    std::set<std::uint32_t> out;
    for (;;) {
      const auto message = client.receive();
      EXPECT_TRUE(message);
      if (!message || (!message->binary && message->text().find("done") != std::string::npos))
        return out;
      if (message->binary)
        out.insert(static_cast<std::uint32_t>(message->bytes[4] | message->bytes[5] << 8));
    }
  }

  test::TempFolder folder_;
  test::ServedFolder files_;
  MeshStore store_;
  std::atomic<bool> go_ = false;
  std::atomic<int> jobs_ = 0;
  std::optional<test::RunningServer> server_;
};

TEST_F(IsovalueStreamTest, aStreamBeginsInThePlainOrderAndGoesOnByTheValuesOnceTheyAreKnown) {
  test::StreamClient client(server_->port());
  client.send(
      R"({"type":"open","mesh":"slope","fields":["Height"],"target":{"level":4000},"credit":0,"view":)" +
      std::string(kView) + "}");
  const auto opened = client.receiveWord();
  ASSERT_TRUE(opened && std::holds_alternative<OpenedMessage>(*opened));
  const std::uint64_t whole = std::get<OpenedMessage>(*opened).planned;
  go_ = true;
  const auto word = client.receiveWord();
  ASSERT_TRUE(word && std::holds_alternative<PlannedMessage>(*word));
  EXPECT_LT(std::get<PlannedMessage>(*word).planned, whole);
  EXPECT_EQ(std::get<PlannedMessage>(*word).view, 0u);
  client.send(R"({"type":"credit","bytes":9007199254740991})");
  const auto first = chunks(client);
  EXPECT_LT(first.size(), store_.find("slope")->log.index().chunks.size());

  test::StreamClient second(server_->port());
  second.send(open(R"(,"view":)" + std::string(kView)));
  const auto again = second.receiveWord();
  ASSERT_TRUE(again && std::holds_alternative<OpenedMessage>(*again));
  EXPECT_EQ(std::get<OpenedMessage>(*again).planned, std::get<PlannedMessage>(*word).planned)
      << "known by now";
  EXPECT_EQ(chunks(second), first);
  EXPECT_EQ(jobs_, 1);
}

TEST_F(IsovalueStreamTest, nobodyWaitsForTheValuesAndTheJobEndsWithTheLastWhoWantsThem) {
  {
    test::StreamClient client(server_->port());
    client.send(open(R"(,"view":)" + std::string(kView)));
    ASSERT_TRUE(client.receiveWord());
    EXPECT_EQ(chunks(client).size(), store_.find("slope")->log.index().chunks.size())
        << "all of it, in the plain order";
    client.send(R"({"type":"view","view":null})");
    ASSERT_TRUE(client.receiveWord());
  }
  EXPECT_TRUE(server_->comesTo("levels_cancelled_total", 1));
  EXPECT_FALSE(store_.find("slope")->intervals->now());
}

TEST_F(IsovalueStreamTest, theTableIsNoLevelThatSomebodyCouldFetch) {
  go_ = true;
  test::RawClient http(server_->port());
  EXPECT_EQ(
      http.get("/v1/logs/" + store_.find("slope")->log.digest() + "/levels/0.intervals").status,
      404u);
}

TEST_F(PacketIntervalsTest, bytesOfAllTablesAreThoseThatSomebodyHolds) {
  const std::uintmax_t before = KnownIntervals::bytesOfAll();
  const std::size_t one = table_.bytes();
  EXPECT_GT(one, 0u);
  {
    KnownIntervals first, second;
    first.put(table_);
    second.put(table_);
    EXPECT_EQ(KnownIntervals::bytesOfAll(), before + 2 * one);
    first.put(table_);
    EXPECT_EQ(KnownIntervals::bytesOfAll(), before + 2 * one) << "the old one has gone";
    const auto held = second.now();
    second.put({});
    EXPECT_EQ(KnownIntervals::bytesOfAll(), before + 2 * one) << "somebody holds it";
  }
  EXPECT_EQ(KnownIntervals::bytesOfAll(), before);
}

}  // namespace
}  // namespace qtet

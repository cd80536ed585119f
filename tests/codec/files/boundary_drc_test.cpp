#include "codec/files/boundary_drc.h"

#include <draco/compression/decode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "codec/files/boundary_glb.h"
#include "proto/limits.h"

namespace qtet {
namespace {

/// A wavy square of 2 (n - 1)^2 triangles on a lattice of `bits`, with a vertex that no triangle
/// uses, a scalar and a vector.
LatticeMesh wavySquare(int n, int bits, double step, const std::array<double, 3>& origin) {
  LatticeMesh mesh;
  mesh.lattice = {bits, step, origin};
  std::mt19937 random(7);
  const auto cell = static_cast<std::uint32_t>((1 << bits) / n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      mesh.points.push_back(
          {static_cast<int>(static_cast<std::uint32_t>(i) * cell + random() % cell),
           static_cast<int>(static_cast<std::uint32_t>(j) * cell + random() % cell),
           static_cast<int>(random() % (1u << bits))});
  mesh.points[0] = {0, 0, 0};
  mesh.points[1] = {(1 << bits) - 1, (1 << bits) - 1, (1 << bits) - 1};
  mesh.points.push_back({1, 2, 3});
  const auto width = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i + 1 < width; ++i)
    for (std::uint32_t j = 0; j + 1 < width; ++j) {
      const std::uint32_t a = i * width + j;
      mesh.boundary.push_back({a, a + width, a + 1});
      mesh.boundary.push_back({a + 1, a + width, a + width + 1});
    }
  mesh.fields.push_back(
      {.name = "density", .components = 1, .bits = 12, .step = 0.25, .minimum = {-7}});
  mesh.fields.push_back(
      {.name = "velocity", .components = 3, .bits = 16, .step = 0.001, .minimum = {-3, 0, 12}});
  for (const FieldInfo& field : mesh.fields) {
    mesh.values.emplace_back();
    for (std::size_t i = 0; i < mesh.points.size() * field.components; ++i)
      mesh.values.back().push_back(static_cast<std::int32_t>(random() % (1u << field.bits)));
  }
  return mesh;
}

std::unique_ptr<draco::Mesh> decode(const Bytes& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto out = decoder.DecodeMeshFromBuffer(&buffer);
  return out.ok() ? std::move(out).value() : nullptr;
}

/// Grid numbers of one decoded attribute of one point, with how far each was from its grid.
std::vector<std::int32_t> gridValue(const draco::PointAttribute& attribute, std::uint32_t point,
                                    const std::vector<double>& origin, double step) {
  std::vector<float> raw(origin.size());
  attribute.GetMappedValue(draco::PointIndex(point), raw.data());
  std::vector<std::int32_t> out;
  for (std::size_t c = 0; c < origin.size(); ++c)
    out.push_back(
        static_cast<std::int32_t>(std::lround((static_cast<double>(raw[c]) - origin[c]) / step)));
  return out;
}

/// Per triangle corner, everything that a vertex carries; sorted, since Draco numbers them again.
using Corner = std::vector<std::int32_t>;
std::vector<std::vector<Corner>> sorted(std::vector<std::vector<Corner>> triangles) {
  for (auto& corners : triangles) std::ranges::rotate(corners, std::ranges::min_element(corners));
  std::ranges::sort(triangles);
  return triangles;
}

std::vector<std::vector<Corner>> trianglesOf(const LatticeMesh& mesh) {
  std::vector<std::vector<Corner>> out;
  for (const Triangle& triangle : mesh.boundary) {
    out.emplace_back();
    for (const VertexId v : triangle) {
      Corner corner(mesh.points[v].begin(), mesh.points[v].end());
      for (std::size_t f = 0; f < mesh.fields.size(); ++f)
        for (std::uint32_t c = 0; c < mesh.fields[f].components; ++c)
          corner.push_back(mesh.values[f][std::size_t{v} * mesh.fields[f].components + c]);
      out.back().push_back(std::move(corner));
    }
  }
  return sorted(std::move(out));
}

std::vector<std::vector<Corner>> trianglesOf(const draco::Mesh& decoded,
                                             const LatticeMesh& original) {
  std::vector<std::vector<Corner>> out;
  for (std::uint32_t i = 0; i < decoded.num_faces(); ++i) {
    out.emplace_back();
    for (const draco::PointIndex& p : decoded.face(draco::FaceIndex(i))) {
      const auto& lattice = original.lattice;
      Corner corner =
          gridValue(*decoded.GetNamedAttribute(draco::GeometryAttribute::POSITION), p.value(),
                    {lattice.origin.begin(), lattice.origin.end()}, lattice.step);
      for (const FieldInfo& field : original.fields) {
        const auto* attribute = decoded.GetAttributeByUniqueId(
            static_cast<std::uint32_t>(decoded.GetMetadata()
                                           ->GetAttributeMetadataByStringEntry("name", field.name)
                                           ->att_unique_id()));
        const auto values = gridValue(*attribute, p.value(), field.minimum, field.step);
        corner.insert(corner.end(), values.begin(), values.end());
      }
      out.back().push_back(std::move(corner));
    }
  }
  return sorted(std::move(out));
}

TEST(BoundaryDrc, everyTriangleKeepsItsLatticePointsItsOrientationAndItsFields) {
  struct Case {
    int bits;
    double step;
    std::array<double, 3> origin;
  };
  for (const Case& c : {Case{16, 0.001, {-30.5, 2, 100.25}}, Case{16, 1.0 / 3, {0, 0, 0}},
                        Case{10, 1e-9, {1e-6, 0, -1e-6}}, Case{18, 1e6, {-2.6e11, 0, 1e11}},
                        Case{4, 1, {0, 0, 0}}}) {
    const LatticeMesh mesh = wavySquare(c.bits == 4 ? 4 : 30, c.bits, c.step, c.origin);
    const Result<Bytes> bytes = boundaryDrc(mesh);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto decoded = decode(*bytes);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(trianglesOf(*decoded, mesh), trianglesOf(mesh)) << c.bits << " bits";
  }
}

TEST(BoundaryDrc, onlyTheBoundarysVerticesAreStored) {
  const LatticeMesh mesh = wavySquare(10, 16, 1, {0, 0, 0});
  const auto decoded = decode(*boundaryDrc(mesh));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->num_points(), mesh.points.size() - 1);
}

TEST(BoundaryDrc, theSameMeshGivesTheSameBytes) {
  const LatticeMesh mesh = wavySquare(10, 16, 1, {0, 0, 0});
  EXPECT_EQ(*boundaryDrc(mesh), *boundaryDrc(mesh));
}

TEST(BoundaryDrc, valuesThatLeaveTheFieldsBitsAsThoseOfCoarseLevelsDoComeBack) {
  LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
  const std::int32_t above = 1 << mesh.fields[0].bits;
  for (std::size_t i = 0; i < mesh.values[0].size(); i += 3)
    mesh.values[0][i] = i % 2 == 0 ? -5 : above + 7;
  const auto decoded = decode(*boundaryDrc(mesh));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(trianglesOf(*decoded, mesh), trianglesOf(mesh));
}

TEST(BoundaryDrc, aFieldOfMoreBitsThanAFloatHasIsStoredAsItsNearestFloat) {
  LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
  mesh.fields.resize(1);
  mesh.values.resize(1);
  mesh.fields[0] = {.name = "id", .components = 1, .bits = 28, .step = 1, .minimum = {0}};
  for (std::size_t i = 0; i < mesh.values[0].size(); ++i)
    mesh.values[0][i] = static_cast<std::int32_t>(i * 1000003);
  const auto decoded = decode(*boundaryDrc(mesh));
  ASSERT_TRUE(decoded);
  const auto* attribute = decoded->GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  std::vector<float> stored;
  for (std::uint32_t p = 0; p < decoded->num_points(); ++p) {
    float value = 0;
    attribute->GetMappedValue(draco::PointIndex(p), &value);
    stored.push_back(value);
  }
  std::vector<float> expected;
  for (std::size_t i = 0; i + 1 < mesh.points.size(); ++i)
    expected.push_back(static_cast<float>(mesh.values[0][i]));
  std::ranges::sort(stored);
  EXPECT_EQ(stored, expected);
}

TEST(BoundaryDrc, aGapIsNotANumberAndTheValuesRoundItStay) {
  LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
  mesh.fields.resize(1);
  mesh.values.resize(1);
  mesh.fields[0].hasMissing = true;
  for (std::size_t i = 0; i < mesh.values[0].size(); i += 3) mesh.values[0][i] = kMissing;
  const auto bytes = boundaryDrc(mesh);
  ASSERT_TRUE(bytes) << bytes.error().text();
  const auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded);
  std::map<std::vector<std::int32_t>, std::int32_t> values;  // by lattice point
  for (std::size_t i = 0; i + 1 < mesh.points.size(); ++i)
    values[{mesh.points[i].begin(), mesh.points[i].end()}] = mesh.values[0][i];
  for (std::uint32_t p = 0; p < decoded->num_points(); ++p) {
    const std::int32_t wanted = values.at(gridValue(
        *decoded->GetNamedAttribute(draco::GeometryAttribute::POSITION), p, {0, 0, 0}, 1));
    float value = 0;
    decoded->GetNamedAttribute(draco::GeometryAttribute::GENERIC)
        ->GetMappedValue(draco::PointIndex(p), &value);
    if (wanted == kMissing)
      EXPECT_TRUE(std::isnan(value)) << value;
    else
      EXPECT_EQ(value, mesh.fields[0].value(0, wanted));
  }
}

/// The values of the first field that were stored, ascending.
std::vector<float> storedValues(const Bytes& bytes) {
  const auto decoded = decode(bytes);
  std::vector<float> stored;
  for (std::uint32_t p = 0; decoded && p < decoded->num_points(); ++p) {
    float value = 0;
    decoded->GetNamedAttribute(draco::GeometryAttribute::GENERIC)
        ->GetMappedValue(draco::PointIndex(p), &value);
    stored.push_back(value);
  }
  std::ranges::sort(stored);
  return stored;
}

/// A log may say anything of its fields, and the integers of a coarse level may lie anywhere.
TEST(BoundaryDrc, valuesFarOutsideAFieldsRangeAreStoredAsTheirNearestFloats) {
  for (const double step : {0.25, 1e36, 1e300})
    for (const std::int32_t far : {1 << 13, 1 << 20, 1 << 29, 1 << 30}) {
      LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
      mesh.fields.resize(1);
      mesh.values.resize(1);
      mesh.fields[0].step = step;
      for (std::size_t i = 0; i < mesh.values[0].size(); ++i)
        mesh.values[0][i] = i % 3 == 0 ? far : i % 3 == 1 ? -far : 5;
      std::vector<float> wanted;
      for (std::size_t i = 0; i + 1 < mesh.points.size(); ++i)
        wanted.push_back(static_cast<float>(std::clamp<double>(
            mesh.fields[0].value(0, mesh.values[0][i]), std::numeric_limits<float>::lowest(),
            std::numeric_limits<float>::max())));
      std::ranges::sort(wanted);
      const auto bytes = boundaryDrc(mesh);
      ASSERT_TRUE(bytes) << bytes.error().text();
      EXPECT_EQ(storedValues(*bytes), wanted) << step << " " << far;
    }
}

TEST(BoundaryDrc, coordinatesBeyondFloatsAreRefused) {
  for (const auto& [step, origin] :
       {std::pair{1e300, 0.0}, {1.0, 1e300}, {1.0, -1e300}, {1e35, 3e37}}) {
    const auto bytes = boundaryDrc(wavySquare(8, 12, step, {0, origin, 0}));
    ASSERT_FALSE(bytes) << step << " " << origin;
    EXPECT_EQ(bytes.error().code, ErrorCode::kBadInput);
  }
  EXPECT_TRUE(boundaryDrc(wavySquare(8, 12, 1e33, {0, 5e37, 0})));
}

/// A square of 18 triangles with `points` scalar point fields, f0, f1 and so on. Each has values
/// of its own.
LatticeMesh meshOfFields(std::uint32_t points) {
  LatticeMesh mesh = wavySquare(4, 12, 1, {0, 0, 0});
  mesh.fields.clear();
  mesh.values.clear();
  for (std::uint32_t f = 0; f < points; ++f) {
    mesh.fields.push_back(
        {.name = "f" + std::to_string(f), .components = 1, .bits = 16, .step = 1, .minimum = {0}});
    mesh.values.emplace_back();
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i)
      mesh.values.back().push_back(static_cast<std::int32_t>(7 * f + i));
  }
  return mesh;
}

constexpr std::array<std::uint32_t, 11> kFieldCounts = {1,   126, 127, 128, 129, 254,
                                                        255, 256, 257, 258, 8192};

void expectTooManyFields(const Result<Bytes>& bytes, std::uint32_t count, std::uint32_t most) {
  ASSERT_FALSE(bytes) << count;
  EXPECT_EQ(bytes.error().code, ErrorCode::kBadInput);
  for (const std::string& said :
       {std::to_string(count) + " point fields", "at most " + std::to_string(most),
        std::string("`fields`"), std::string("`time`")})
    EXPECT_NE(bytes.error().message.find(said), std::string::npos) << bytes.error().message;
}

TEST(BoundaryDrc, everyOneOf128FieldsComesBackAndMoreAreRefused) {
  for (const std::uint32_t count : kFieldCounts) {
    const LatticeMesh mesh = meshOfFields(count);
    const auto bytes = boundaryDrc(mesh);
    if (count > 128) {
      expectTooManyFields(bytes, count, 128);
      continue;
    }
    ASSERT_TRUE(bytes) << bytes.error().text();
    const auto decoded = decode(*bytes);
    ASSERT_TRUE(decoded) << count;
    EXPECT_EQ(decoded->num_attributes(), static_cast<int>(count) + 1);
    EXPECT_EQ(trianglesOf(*decoded, mesh), trianglesOf(mesh)) << count;
  }
}

TEST(BoundaryDrc, fieldsOfCellsDoNotCountAmongThe128) {
  LatticeMesh mesh = meshOfFields(129);
  for (FieldInfo& field : mesh.fields) field.association = "cell";
  for (auto& values : mesh.values) values.clear();
  const auto bytes = boundaryDrc(mesh);
  ASSERT_TRUE(bytes) << bytes.error().text();
  ASSERT_TRUE(decode(*bytes));
  EXPECT_EQ(decode(*bytes)->num_attributes(), 1);
}

TEST(BoundaryDrc, fieldsOfTheMostComponentsAndTheLongestNamesComeBack) {
  LatticeMesh mesh = wavySquare(4, 12, 1, {0, 0, 0});
  mesh.fields = {{.name = std::string(kMaxNameBytes, 'n'),
                  .components = kMaxFieldComponents,
                  .bits = 12,
                  .step = 0.25,
                  .minimum = std::vector<double>(kMaxFieldComponents, -7.0)}};
  mesh.values.assign(1, {});
  for (std::uint32_t i = 0; i < mesh.points.size() * kMaxFieldComponents; ++i)
    mesh.values[0].push_back(static_cast<std::int32_t>(i * 37 % 4096));
  const auto bytes = boundaryDrc(mesh);
  ASSERT_TRUE(bytes) << bytes.error().text();
  const auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(trianglesOf(*decoded, mesh), trianglesOf(mesh));
}

TEST(BoundaryGlb, namesFieldsWithoutGapsAlone) {
  LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
  const auto json = [&] {
    const auto glb = boundaryGlb(mesh);
    EXPECT_TRUE(glb) << glb.error().text();
    return nlohmann::json::parse(
        glb->begin() + 20,
        glb->begin() + 20 + ByteReader(ByteView(*glb).subspan(12)).read<std::uint32_t>());
  };
  const auto primitive = [&] { return json()["meshes"][0]["primitives"][0]; };
  EXPECT_TRUE(primitive()["attributes"].contains("_density"));
  EXPECT_TRUE(primitive()["attributes"].contains("_velocity"));
  mesh.fields[0].hasMissing = true;
  mesh.values[0][3] = kMissing;
  EXPECT_FALSE(primitive()["attributes"].contains("_density"));
  EXPECT_TRUE(primitive()["attributes"].contains("_velocity"));
  EXPECT_EQ(json()["accessors"].size(), 4u);  // indices, positions, velocity, colours
  for (const auto& accessor : json()["accessors"]) EXPECT_GT(accessor["count"], 0);
}

/// The Draco mesh in a .glb whose JSON chunk and its padding come first.
std::unique_ptr<draco::Mesh> decodeGlb(const Bytes& glb) {
  const std::size_t json = ByteReader(ByteView(glb).subspan(12)).read<std::uint32_t>();
  return decode(Bytes(glb.begin() + static_cast<std::ptrdiff_t>(28 + json), glb.end()));
}

TEST(BoundaryGlb, theFirstPointFieldIsTheColoursInLinearLight) {
  LatticeMesh mesh = wavySquare(8, 12, 1, {0, 0, 0});
  mesh.fields[0].range = {-7, -7 + 0.25 * 4095};
  mesh.values[0][0] = 0;     // the lowest value at lattice point (0, 0, 0)
  mesh.values[0][1] = 4095;  // the highest at the opposite corner
  const auto glb = boundaryGlb(mesh);
  ASSERT_TRUE(glb);
  const auto decoded = decodeGlb(*glb);
  ASSERT_TRUE(decoded);
  const auto* colours = decoded->GetNamedAttribute(draco::GeometryAttribute::COLOR);
  const auto* positions = decoded->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  ASSERT_NE(colours, nullptr);
  EXPECT_TRUE(colours->normalized());
  int ends = 0;
  for (draco::PointIndex p(0); p < decoded->num_points(); ++p) {
    std::array<float, 3> at{};
    std::array<std::uint8_t, 3> colour{};
    positions->GetMappedValue(p, at.data());
    colours->GetMappedValue(p, colour.data());
    // viridis' ends, (0.267, 0.005, 0.329) and (0.993, 0.906, 0.144) in sRGB
    if (at[0] < 0.5f && at[1] < 0.5f) {
      ++ends;
      EXPECT_EQ(colour, (std::array<std::uint8_t, 3>{15, 0, 23}));
    } else if (at[0] > 4094.5f && at[1] > 4094.5f) {
      ++ends;
      EXPECT_EQ(colour, (std::array<std::uint8_t, 3>{251, 204, 5}));
    }
  }
  EXPECT_EQ(ends, 2);
  mesh.fields.clear();
  mesh.values.clear();
  const auto plain = boundaryGlb(mesh);
  ASSERT_TRUE(plain);
  EXPECT_EQ(decodeGlb(*plain)->GetNamedAttribute(draco::GeometryAttribute::COLOR), nullptr);
}

/// The JSON of a .glb, and what an accessor's bytes are.
struct ReadGlb {
  explicit ReadGlb(const Bytes& glb) {
    const std::size_t length = ByteReader(ByteView(glb).subspan(12)).read<std::uint32_t>();
    json = nlohmann::json::parse(glb.begin() + 20,
                                 glb.begin() + 20 + static_cast<std::ptrdiff_t>(length));
    buffer = Bytes(glb.begin() + static_cast<std::ptrdiff_t>(28 + length), glb.end());
    primitive = json["meshes"][0]["primitives"][0];
  }
  template <class T>
  [[nodiscard]] std::vector<T> array(std::size_t accessor) const {
    const auto& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<int>()];
    std::vector<T> out(view["byteLength"].get<std::size_t>() / sizeof(T));
    std::memcpy(out.data(), buffer.data() + view["byteOffset"].get<std::size_t>(),
                out.size() * sizeof(T));
    return out;
  }
  template <class T>
  [[nodiscard]] std::vector<T> attribute(const char* name) const {
    return array<T>(primitive["attributes"][name].get<std::size_t>());
  }

  nlohmann::json json, primitive;
  Bytes buffer;
};

TEST(BoundaryGlb, everyOneOf127FieldsComesBackBesideTheColoursAndMoreAreRefused) {
  for (const std::uint32_t count : kFieldCounts) {
    const LatticeMesh mesh = meshOfFields(count);
    const auto glb = boundaryGlb(mesh);
    if (count > 127) {
      expectTooManyFields(glb, count, 127);
      continue;
    }
    ASSERT_TRUE(glb) << glb.error().text();
    const auto decoded = decodeGlb(*glb);
    ASSERT_TRUE(decoded) << count;
    EXPECT_EQ(decoded->num_attributes(), static_cast<int>(count) + 2);
    EXPECT_EQ(trianglesOf(*decoded, mesh), trianglesOf(mesh)) << count;
    const ReadGlb read(*glb);
    const nlohmann::json& ids =
        read.primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    ASSERT_EQ(ids.size(), count + 2) << ids;
    for (const FieldInfo& field : mesh.fields)
      EXPECT_EQ(ids["_" + field.name], decoded->GetMetadata()
                                           ->GetAttributeMetadataByStringEntry("name", field.name)
                                           ->att_unique_id());
  }
}

TEST(BoundaryGlb, withoutDracoMoreFieldsThanItTakesStandThere) {
  for (const std::uint32_t count : {127u, 128u, 255u, 256u, 257u, 1000u}) {
    const LatticeMesh mesh = meshOfFields(count);
    const auto glb = plainBoundaryGlb(mesh);
    ASSERT_TRUE(glb) << glb.error().text();
    const ReadGlb read(*glb);
    for (const std::uint32_t f : {0u, 126u, count - 1}) {
      const auto values = read.attribute<float>(("_f" + std::to_string(f)).c_str());
      ASSERT_EQ(values.size(), mesh.points.size() - 1);  // no triangle uses the last one
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(values[i], static_cast<float>(mesh.values[f][i])) << count << " " << f;
    }
  }
}

TEST(BoundaryGlb, withoutDracoTheNumbersStandThere) {
  LatticeMesh mesh = wavySquare(8, 12, 0.5, {10, -3, 0});
  const auto glb = plainBoundaryGlb(mesh);
  ASSERT_TRUE(glb) << glb.error().text();
  const ReadGlb read(*glb);
  EXPECT_FALSE(read.json.contains("extensionsRequired"));
  const std::size_t points = mesh.points.size() - 1;  // no triangle uses the last one
  const auto positions = read.attribute<float>("POSITION");
  ASSERT_EQ(positions.size(), 3 * points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto wanted = mesh.lattice.position(mesh.points[i]);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_EQ(positions[3 * i + a], static_cast<float>(wanted[a]));
  }
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : mesh.boundary)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  EXPECT_EQ(read.array<std::uint32_t>(0), corners);
  const auto velocity = read.attribute<float>("_velocity");
  ASSERT_EQ(velocity.size(), 3 * points);
  EXPECT_EQ(velocity[5], static_cast<float>(mesh.fields[1].value(2, mesh.values[1][5])));
  EXPECT_EQ(read.attribute<std::uint8_t>("COLOR_0").size(), 4 * points);
  for (const auto& view : read.json["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<int>() % 4, 0);
  mesh.fields[0].hasMissing = true;
  EXPECT_FALSE(ReadGlb(*plainBoundaryGlb(mesh)).primitive["attributes"].contains("_density"));
}

// float32 has a step of 0.5 there.
TEST(BoundaryGlb, positionsOfAMapAreToldFromThePlaceOfTheNode) {
  const LatticeMesh mesh = wavySquare(8, 12, 0.001, {500000.25, 4649776.5, 120});
  const auto plain = plainBoundaryGlb(mesh), packed = boundaryGlb(mesh);
  ASSERT_TRUE(plain && packed);
  const ReadGlb read(*plain);
  const auto place = read.json["nodes"][0]["translation"].get<std::array<double, 3>>();
  EXPECT_EQ(place, mesh.lattice.origin);
  EXPECT_EQ(ReadGlb(*packed).json["nodes"][0]["translation"].get<std::vector<double>>(),
            std::vector<double>(place.begin(), place.end()));
  const auto positions = read.attribute<float>("POSITION");
  for (std::size_t i = 0; i + 1 < mesh.points.size(); ++i) {
    const auto wanted = mesh.lattice.position(mesh.points[i]);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(place[a] + double{positions[3 * i + a]}, wanted[a], 1e-6);
  }
  const auto decoded = decodeGlb(*packed);
  ASSERT_TRUE(decoded);
  const auto* stored = decoded->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  std::set<std::vector<std::int32_t>> places;
  for (std::uint32_t p = 0; p < decoded->num_points(); ++p)
    places.insert(gridValue(*stored, p, {0, 0, 0}, 0.001));
  for (std::size_t i = 0; i + 1 < mesh.points.size(); ++i)
    EXPECT_TRUE(places.contains({mesh.points[i].begin(), mesh.points[i].end()})) << i;
  EXPECT_FALSE(ReadGlb(*plainBoundaryGlb(wavySquare(8, 12, 0.5, {10, -3, 0})))
                   .json["nodes"][0]
                   .contains("translation"))
      << "where float32 does";
}

TEST(BoundaryGlb, withoutDracoTheSameIsRefused) {
  for (const LatticeMesh& mesh : {LatticeMesh(), wavySquare(8, 12, 1e300, {0, 0, 0})}) {
    const auto glb = plainBoundaryGlb(mesh);
    ASSERT_FALSE(glb);
    EXPECT_EQ(glb.error().code, ErrorCode::kBadInput);
  }
}

TEST(BoundaryDrc, aMeshWithoutABoundaryIsRefused) {
  const Result<Bytes> bytes = boundaryDrc(LatticeMesh());
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet

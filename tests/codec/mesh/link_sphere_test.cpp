// Link says of any triangles whether they are one sphere as the definition does.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codec/mesh/link.h"
#include "tests/support/plain_sphere.h"

namespace qtet {
namespace {

using Triangles = std::vector<Triangle>;

constexpr VertexId kVertices = 400;

bool isSphere(const Triangles& triangles) {
  static Link link;  // what was asked before has no say
  link.clear(kVertices);
  link.add(triangles);
  const bool is = link.close() && link.isSphere();
  EXPECT_EQ(is, testing::isPlainSphere(triangles)) << triangles.size() << " triangles";
  return is;
}

/// Two apexes over a ring of n vertices.
Triangles doubleCone(VertexId n, VertexId first = 0) {
  Triangles out;
  for (VertexId i = 0; i < n; ++i) {
    const VertexId a = first + 2 + i, b = first + 2 + (i + 1) % n;
    out.push_back({first, a, b});
    out.push_back({first + 1, b, a});
  }
  return out;
}

/// Moebius' torus of seven vertices.
Triangles torus(VertexId first) {
  Triangles out;
  for (VertexId i = 0; i < 7; ++i) {
    out.push_back({first + i, first + (i + 1) % 7, first + (i + 3) % 7});
    out.push_back({first + i, first + (i + 3) % 7, first + (i + 2) % 7});
  }
  return out;
}

Triangles both(Triangles a, const Triangles& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void rename(Triangles& triangles, VertexId from, VertexId to) {
  for (Triangle& t : triangles) std::ranges::replace(t, from, to);
}

TEST(LinkSphere, spheresOfAnySizeAreKnownWithAndWithoutTheGhost) {
  for (const VertexId ring : {3u, 4u, 17u, 60u, 61u, 62u, 63u, 64u, 65u, 150u}) {
    Triangles sphere = doubleCone(ring);
    EXPECT_TRUE(isSphere(sphere)) << ring;
    rename(sphere, 0, kGhost);
    EXPECT_TRUE(isSphere(sphere)) << ring;
  }
}

TEST(LinkSphere, anOpenSurfaceAndATurnedTriangleAreNone) {
  Triangles sphere = doubleCone(6);
  sphere.pop_back();
  EXPECT_FALSE(isSphere(sphere));
  sphere = doubleCone(6);
  std::swap(sphere[3][0], sphere[3][1]);
  EXPECT_FALSE(isSphere(sphere));
}

TEST(LinkSphere, surfacesOfCharacteristicTwoThatDoNotHangTogetherAreNone) {
  EXPECT_FALSE(isSphere(both(doubleCone(5), torus(10)))) << "a sphere and a torus";
  Triangles other = doubleCone(5, 10);
  rename(other, 10, 0), rename(other, 11, 1);
  EXPECT_FALSE(isSphere(both(doubleCone(5), other))) << "two spheres that share two vertices";
}

TEST(LinkSphere, aTorusTwoSpheresAndAPinchedSphereAreNone) {
  EXPECT_FALSE(isSphere(torus(0)));
  EXPECT_FALSE(isSphere(both(doubleCone(5), doubleCone(4, 20))));
  Triangles pinched = doubleCone(8);
  rename(pinched, 1, 0);
  EXPECT_FALSE(isSphere(pinched)) << "its poles are one vertex";
}

TEST(LinkSphere, agreesWithTheDefinitionOnWhateverTriangles) {
  std::mt19937 random(7);
  std::size_t spheres = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Triangles link = both(
        doubleCone(static_cast<VertexId>(3 + random() % 5)),
        trial % 2 == 0 ? doubleCone(static_cast<VertexId>(3 + random() % 3), 20) : Triangles{});
    for (auto i = random() % 3; i > 0; --i) {
      Triangle& t = link[random() % link.size()];
      const VertexId to = link[random() % link.size()][random() % 3];
      switch (random() % 3) {
        case 0: t[random() % 3] = to; break;
        case 1: rename(link, t[0], to); break;
        default: std::swap(t[0], t[1]);
      }
    }
    std::erase_if(link,
                  [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[0] == t[2]; });
    std::ranges::shuffle(link, random);
    if (!link.empty()) spheres += isSphere(link);
    if (HasFailure()) return;
  }
  EXPECT_GT(spheres, 2000u);
  EXPECT_LT(spheres, 18000u);
}

}  // namespace
}  // namespace qtet

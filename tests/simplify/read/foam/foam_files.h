// Files of OpenFOAM for the tests of its reader.
#pragma once

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace qtet::testing {

/// The header of a file, before its body.
[[nodiscard]] inline std::string foamHeader(const std::string& kind,
                                            const std::string& format = "ascii",
                                            const std::string& arch = "") {
  return "FoamFile\n{\n version 2.0;\n format " + format + ";\n" +
         (arch.empty() ? "" : " arch \"" + arch + "\";\n") + " class " + kind +
         ";\n object x;\n}\n";
}

/// A file as text, with its folders.
inline void writeFoam(const std::filesystem::path& path, const std::string& kind,
                      const std::string& body) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << foamHeader(kind) << body;
}

/// "2\n(\na\nb\n)\n"
[[nodiscard]] inline std::string foamListOf(std::span<const std::string> items) {
  std::string out = std::to_string(items.size()) + "\n(\n";
  for (const std::string& item : items) out += item + "\n";
  return out + ")\n";
}

/// The bytes of numbers, as binary files have them.
template <class T>
[[nodiscard]] std::string bytesOf(std::initializer_list<T> numbers) {
  std::string out;
  for (const T number : numbers) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(number);
    out.append(bytes.begin(), bytes.end());
  }
  return out;
}

/// A field of cells or points, `value` being "uniform 1" or the like.
inline void writeFoamField(const std::filesystem::path& path, const std::string& kind,
                           const std::string& value) {
  const std::string key = kind.ends_with("::Internal") ? "value" : "internalField";
  writeFoam(path, kind,
            "dimensions [0 2 -2 0 0 0 0];\n" + key + " " + value +
                ";\nboundaryField\n{\n walls\n {\n type zeroGradient;\n }\n}\n");
}

/// Two cubes beside each other from x on, the second with one face cut into two: a polyhedron of
/// seven faces.
inline void writeTwoCubes(const std::filesystem::path& polyMesh, int x = 0) {
  std::vector<std::string> points;
  for (const char* place : {"0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "2 1 0", "0 0 1", "1 0 1",
                            "2 0 1", "0 1 1", "1 1 1", "2 1 1", "2 0.5 0", "2 0.5 1"}) {
    std::string point = place;
    point.replace(0, 1, std::to_string(point[0] - '0' + x));
    points.push_back("(" + point + ")");
  }
  writeFoam(polyMesh / "points", "vectorField", foamListOf(points));
  writeFoam(polyMesh / "faces", "faceList",
            "12\n(\n4(1 4 10 7)\n4(0 6 9 3)\n4(0 1 7 6)\n4(3 9 10 4)\n4(0 3 4 1)\n4(6 7 10 9)\n"
            "4(2 12 13 8)\n4(12 5 11 13)\n4(1 2 8 7)\n4(4 10 11 5)\n5(1 4 5 12 2)\n"
            "5(7 8 13 11 10)\n)\n");
  writeFoam(polyMesh / "owner", "labelList", "12\n(\n0\n0\n0\n0\n0\n0\n1\n1\n1\n1\n1\n1\n)\n");
  writeFoam(polyMesh / "neighbour", "labelList", "1\n(\n1\n)\n");
  writeFoam(polyMesh / "boundary", "polyBoundaryMesh",
            "1\n(\nwalls\n{\n type wall;\n nFaces 11;\n startFace 1;\n}\n)\n");
}

/// One tetrahedron, whose owners are `owner`.
inline void writeOneTetrahedron(const std::filesystem::path& polyMesh,
                                const std::string& owner = "4\n(\n0\n0\n0\n0\n)\n") {
  writeFoam(polyMesh / "points", "vectorField", "4\n(\n(0 0 0)\n(1 0 0)\n(0 1 0)\n(0 0 1)\n)\n");
  writeFoam(polyMesh / "faces", "faceList", "4\n(\n3(0 2 1)\n3(0 1 3)\n3(0 3 2)\n3(1 2 3)\n)\n");
  writeFoam(polyMesh / "owner", "labelList", owner);
  writeFoam(polyMesh / "neighbour", "labelList", "0\n(\n)\n");
  writeFoam(polyMesh / "boundary", "polyBoundaryMesh",
            "1\n(\nwalls\n{\n type wall;\n nFaces 4;\n startFace 0;\n}\n)\n");
}

}  // namespace qtet::testing

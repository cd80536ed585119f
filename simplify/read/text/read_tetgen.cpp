#include <algorithm>

#include "proto/limits.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/text_readers.h"

namespace qtet {
namespace {

std::vector<MeshField> attributesOf(std::uint64_t count, const char* association) {
  std::vector<MeshField> fields;
  for (std::uint64_t i = 0; i < count; ++i)
    fields.push_back({"attribute-" + std::to_string(i), 1, "float64", {}, association});
  return fields;
}

bool tooMany(MeshScanner& in, std::uint64_t attributes) {
  if (!in.failed() && attributes > kMaxFields)
    in.fail(ErrorCode::kBadInput, std::to_string(attributes) + " attributes; at most " +
                                      std::to_string(kMaxFields) + " are read");
  return in.failed();
}

/// The number of the first point: 0 or 1, which counts everything.
Result<std::uint64_t> readNodes(const std::filesystem::path& path, std::chrono::seconds patience,
                                CellMesh& out) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  MeshScanner in(*text, path, '#');
  in.giveUpAfter(patience);
  const auto count = in.number<std::uint64_t>("the number of points"),
             dimension = in.number<std::uint64_t>("the dimension");
  const auto attributes = in.number<std::uint64_t>("the number of attributes"),
             markers = in.number<std::uint64_t>("0 or 1 for markers");
  if (!in.failed() && dimension != 3)
    in.fail(ErrorCode::kBadInput, "the points have " + std::to_string(dimension) +
                                      " dimensions, not 3; give a volume mesh");
  if (tooMany(in, attributes) ||
      !in.fits(count, (4 + attributes + (markers ? 1 : 0)) * kMinTextBytes, "points"))
    return in.error();
  std::vector<MeshField> fields = attributesOf(attributes, "point");
  std::uint64_t first = 0;
  for (std::uint64_t i = 0; i < count && !in.failed(); ++i) {
    const auto number = in.number<std::uint64_t>("a point's number");
    if (i == 0) first = number;
    if (!in.failed() && (first > 1 || number != first + i))
      in.fail(ErrorCode::kBadInput, "point " + std::to_string(number) + " is where point " +
                                        std::to_string(std::min<std::uint64_t>(first, 1) + i) +
                                        " should be; points are numbered on from 0 or 1");
    Position p{};
    for (double& x : p) x = in.number<double>("a coordinate");
    out.points.push_back(p);
    for (MeshField& field : fields) field.values.push_back(in.number<double>("an attribute"));
    if (markers) in.number<std::int64_t>("a marker");
  }
  in.endsList(count, "points");
  if (in.failed()) return in.error();
  for (MeshField& field : fields) out.fields.push_back(std::move(field));
  return first;
}

Status readElements(const std::filesystem::path& path, std::chrono::seconds patience,
                    std::uint64_t first, CellMesh& out, ReadReport& report) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  MeshScanner in(*text, path, '#');
  in.giveUpAfter(patience);
  const auto count = in.number<std::uint64_t>("the number of tetrahedra"),
             nodes = in.number<std::uint64_t>("the number of nodes of each");
  const auto attributes = in.number<std::uint64_t>("the number of attributes");
  if (!in.failed() && nodes != 4 && nodes != 10)
    in.fail(ErrorCode::kBadInput,
            "tetrahedra of " + std::to_string(nodes) + " nodes; there are 4 or 10");
  if (tooMany(in, attributes) ||
      !in.fits(count, (1 + nodes + attributes) * kMinTextBytes, "tetrahedra"))
    return in.status();
  std::vector<MeshField> fields = attributesOf(attributes, "cell");
  for (std::uint64_t i = 0; i < count && !in.failed(); ++i) {
    in.number<std::uint64_t>("a tetrahedron's number");
    std::array<VertexId, 4> ids{};
    for (std::uint64_t k = 0; k < nodes; ++k) {
      const auto id = in.number<std::uint64_t>("a vertex id");
      if (k < 4)
        ids[k] = id < first || id - first >= kGhost ? kGhost : static_cast<VertexId>(id - first);
    }
    out.addCell(kTetrahedronCell, ids);
    for (MeshField& field : fields) field.values.push_back(in.number<double>("an attribute"));
  }
  in.endsList(count, "tetrahedra");
  if (nodes == 10)
    report.notes.push_back(
        "of its ten-node tetrahedra the corners are read; the other nodes lie on straight edges");
  for (MeshField& field : fields) out.fields.push_back(std::move(field));
  return in.status();
}

}  // namespace

Result<CellMesh> readTetgen(const std::filesystem::path& path, ReadReport& report,
                            std::chrono::seconds patience) {
  std::filesystem::path nodes = path, elements = path;
  nodes.replace_extension(".node");
  elements.replace_extension(".ele");
  for (const std::filesystem::path& file : {nodes, elements}) {
    if (Status checked = checkMeshFile(file, MeshFormat::kTetgen); !checked)
      return fail(
          checked.error().code,
          checked.error().message + " (a TetGen mesh is a .node and an .ele file of one name)");
  }
  CellMesh out;
  const Result<std::uint64_t> first = readNodes(nodes, patience, out);
  if (!first) return std::unexpected(first.error());
  if (Status read = readElements(elements, patience, *first, out, report); !read)
    return std::unexpected(read.error());
  return out;
}

}  // namespace qtet

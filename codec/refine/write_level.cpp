#include "codec/refine/write_level.h"

#include <array>
#include <cassert>

#include "codec/files/mesh_file.h"
#include "codec/log/log_manifest.h"
#include "codec/log/manifest_field.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/level_fields.h"
#include "codec/refine/refiner.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

/// The fields of one association, which the file has in their order.
std::vector<std::uint32_t> fieldsOf(const Manifest& manifest, std::span<const std::uint32_t> fields,
                                    std::string_view association) {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t f : fields)
    if (manifest.fields[f].association == association) out.push_back(f);
  return out;
}

}  // namespace

Status writeLevel(const LogFile& log, std::uint32_t level, std::span<const std::uint32_t> fields,
                  std::span<const std::string> names, std::string_view ending, const ByteSink& sink,
                  const std::stop_token& stop) {
  assert(!needsLattice(ending) && (names.empty() || names.size() == fields.size()));
  const Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  Refiner refiner(log.index());
  if (Status s = refineToLevel(log, refiner, level, {}, stop); !s) return s;
  const LatticeMesh mesh = latticeMesh(*manifest, refiner, {});
  LatticeFileMesh file = fileMesh(mesh);

  LevelFields points(log, refiner, fieldsOf(*manifest, fields, "point"), stop),
      cells(log, refiner, fieldsOf(*manifest, fields, "cell"), stop);
  std::vector<FieldInfo> infos;
  infos.reserve(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::uint32_t f = fields[i];
    const ManifestField& known = manifest->fields[f];
    if (!holdsFields(ending, known.association)) continue;
    FieldInfo& info = infos.emplace_back(fieldInfoOf(known));
    if (const LabelNames* called = labelNamesOf(*manifest, f)) info.labelNames = *called;
    const bool ofCells = isCellField(info);
    FileField& field =
        (ofCells ? file.mesh.cellFields : file.mesh.pointFields).emplace_back(fileField(info));
    if (!names.empty()) field.name = names[i];
    const std::size_t elements = ofCells ? mesh.tetrahedra.size() : mesh.points.size();
    const std::size_t size = elements * info.components;
    LevelFields& source = ofCells ? cells : points;
    field.values = FieldNumbers(size, [&source, &info, f, size] {
      std::vector<double> out = dequantised(info, source.integers(f));
      out.resize(size);  // after an error, which is reported below
      return out;
    });
  }
  const Status written = writeMeshFile(file.mesh, ending, sink);
  for (const LevelFields* decoded : {&points, &cells})
    if (!decoded->status()) return decoded->status();
  return written;
}

}  // namespace qtet

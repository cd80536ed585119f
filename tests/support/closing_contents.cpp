#include "tests/support/closing_contents.h"

#include <bit>

#include "codec/log/exact_values.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/mesh/input_order.h"
#include "codec/mesh/original_cells.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"

namespace qtet::testing {
namespace {

Bytes bytesOf(std::span<const double> numbers) {
  ByteWriter w;
  for (const double x : numbers) w.write(std::bit_cast<std::uint64_t>(x));
  return w.take();
}

Bytes exactPositions(const Manifest& manifest, const Refiner& finest, ByteView block) {
  std::vector<std::int32_t> integers;
  for (const LatticePoint& p : finest.points()) integers.insert(integers.end(), p.begin(), p.end());
  const Approximation known{integers,
                            3,
                            {manifest.latticeOrigin.begin(), manifest.latticeOrigin.end()},
                            manifest.latticeStep,
                            block[0] == 1 ? "float64" : "float32"};
  return bytesOf(decodeExact(known, block.subspan(1)).value());
}

}  // namespace

std::map<std::string, Bytes> closingContents(const LogFile& log, const Refiner& finest) {
  std::map<std::string, Bytes> out;
  const Manifest manifest = manifestOf(log.index()).value();
  const DecodedMesh mesh{finest.points(), finest.tetrahedra()};
  InputOrder order;
  for (const ClosingBlock& c : log.index().closing) {
    const ByteView block = log.closing(c.kind, c.field).value();
    const std::string name =
        std::to_string(static_cast<unsigned>(c.kind)) + "/" + std::to_string(c.field);
    Bytes& content = out[name];
    ByteWriter w;
    if (c.kind == ClosingKind::kPointOrder) {
      order.points = decodePointOrder(mesh, block).value();
      for (const VertexId slot : order.points) w.write(slot);
      content = w.take();
    } else if (c.kind == ClosingKind::kCellOrder) {
      decodeCellOrder(mesh, block, order).value();
      for (const CellId slot : order.cells) w.write(slot);
      for (const Tetrahedron& cell : order.tetrahedra)
        for (const VertexId v : cell) w.write(v);
      content = w.take();
    } else if (c.kind == ClosingKind::kExactPositions) {
      content = exactPositions(manifest, finest, block);
    } else if (c.kind == ClosingKind::kExactField) {
      const ManifestField& f = manifest.fields[c.field];
      content = bytesOf(
          decodeExact({finest.fieldValues(c.field), f.components, f.minimum, f.step, f.type}, block)
              .value());
    } else if (c.kind == ClosingKind::kOriginalCells) {
      const auto ids = decodeOriginalCells(block, mesh.tetrahedra.size()).value();
      for (const std::uint32_t id : ids) w.write(id);
      content = w.take();
    } else {
      out.erase(name);
    }
  }
  return out;
}

}  // namespace qtet::testing

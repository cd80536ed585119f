#include <array>
#include <string>

#include "codec/files/file_names.h"
#include "codec/files/mesh_file.h"

namespace qtet {

Bytes objBytes(const FileSurface& surface) {
  std::string text = "# boundary of a tetrahedral mesh, written by qtet\n";
  for (const std::array<double, 3>& p : surface.points) {
    text += "v";
    for (const double x : p) text += ' ', appendShortest(text, x);
    text += '\n';
  }
  for (const Triangle& t : surface.triangles) {
    text += "f";
    for (const VertexId v : t) text += ' ', appendShortest(text, v + 1);
    text += '\n';
  }
  return {text.begin(), text.end()};
}

}  // namespace qtet

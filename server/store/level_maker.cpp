#include "server/store/level_maker.h"

#include <exception>
#include <new>
#include <string>

#include "codec/files/mesh_file.h"
#include "codec/mesh/mesh.h"
#include "codec/picture/poster.h"
#include "codec/refine/write_level.h"
#include "server/store/series_maker.h"

namespace qtet {
namespace {

/// A file that is made of the whole level: the poster, or one that needs the lattice.
Result<Bytes> fileOf(LatticeMesh& mesh, const LevelRequest& request) {
  for (std::size_t f = 0; f < request.names.size(); ++f) mesh.fields[f].name = request.names[f];
  if (request.form == LevelForm::kWebp) return posterWebp(mesh, request.mesh->manifest);
  return meshFileBytes(mesh, "." + std::string(formName(request.form)));
}

Status sendWhole(const Result<Bytes>& file, const ByteSink& sink) {
  return file ? sink(*file) : std::unexpected(file.error());
}

Status write(const LevelRequest& request, const ByteSink& sink, const std::stop_token& stop,
             SeriesMaker& series) {
  if (request.point) return sendWhole(series.make(request, stop), sink);
  const std::string ending = "." + std::string(formName(request.form));
  if (isMeshFile(request.form) && !needsLattice(ending))
    return writeLevel(request.mesh->log, request.level, request.fields, request.names, ending, sink,
                      stop);
  Result<LatticeMesh> mesh = meshAtLevel(request.mesh->log, request.level, request.fields, stop);
  if (!mesh) return std::unexpected(mesh.error());
  return sendWhole(fileOf(*mesh, request), sink);
}

Status writeCoded(const LevelRequest& request, const ByteSink& sink, const std::stop_token& stop,
                  SeriesMaker& series) {
  if (request.coding == ContentCoding::kIdentity) return write(request, sink, stop, series);
  Bytes whole;
  if (Status s = write(request, appendTo(whole), stop, series); !s) return s;
  return sink(encoded(std::move(whole), request.coding));
}

}  // namespace

Status writeLevel(const LevelRequest& request, const ByteSink& sink, const std::stop_token& stop,
                  SeriesMaker& series) {
  try {
    return writeCoded(request, sink, stop, series);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kIo, "there is not enough memory for this level; ask for a coarser one");
  } catch (const std::exception& error) {  // of a library: it ends one job, not the server
    return fail(ErrorCode::kBadCodec, std::string("this level cannot be written: ") + error.what());
  }
}

Result<Bytes> makeLevel(const LevelRequest& request, const std::stop_token& stop) {
  SeriesMaker series;
  Bytes out;
  if (Status s = writeLevel(request, appendTo(out), stop, series); !s)
    return std::unexpected(s.error());
  return out;
}

Result<LevelFile> makeLevelHere(const LevelRequest& request, const std::stop_token& stop) {
  Result<Bytes> made = makeLevel(request, stop);
  if (!made) return std::unexpected(made.error());
  return inMemory(std::move(*made));
}

}  // namespace qtet

#include "server/routes/log_routes.h"

#include <cassert>
#include <span>

#include "server/http/http_resource.h"
#include "server/routes/level_answer.h"
#include "server/routes/series_routes.h"

namespace qtet {
namespace {

using Path = std::span<const std::string>;

/// Bytes [first, end) of the log. `name` identifies the part in the tag; "" is the whole.
Reply part(const RequestView& request, const MeshPointer& mesh, const std::string& name,
           std::uint64_t first, std::uint64_t end) {
  assert(first <= end && end <= mesh->log.bytes().size());
  const std::string tag = '"' + mesh->log.digest() + (name.empty() ? "" : "-" + name) + '"';
  Resource resource{{tag, mesh->modified}, "application/octet-stream", kForEver};
  becomeMeasurable(resource);
  Reply out = bytesReply(request, resource, mesh->log.bytes().subspan(first, end - first), mesh);
  if (out.status == 200) out.headers.add("Accept-Ranges", "bytes");
  if (const auto* body = std::get_if<ByteView>(&out.body))
    out.file = FilePart{mesh->descriptor->number,
                        static_cast<std::uint64_t>(body->data() - mesh->log.bytes().data())};
  return out;
}

std::uint64_t endOf(const BlockEntry& block) { return block.offset + block.size; }

/// Structure and positions of a chunk, or one field's block of it.
Reply chunkReply(const RequestView& request, const MeshPointer& mesh, std::string_view number,
                 std::optional<std::uint32_t> field) {
  const std::span<const ChunkEntry> chunks = mesh->log.chunks();
  const std::optional<std::uint32_t> chunk = parseIndex(number);
  if (!chunk || *chunk >= chunks.size())
    return missingReply("there is no such chunk; this log has the chunks 0 to " +
                        std::to_string(chunks.size() - 1));
  const std::vector<BlockEntry>& blocks = chunks[*chunk].blocks;
  const BlockEntry& first = blocks[field ? kFirstFieldPart + *field : kStructurePart];
  const BlockEntry& last = blocks[field ? kFirstFieldPart + *field : kPositionsPart];
  const std::string name =
      (field ? "f" + std::to_string(*field) : "c") + "-" + std::to_string(*chunk);
  return part(request, mesh, name, first.offset, endOf(last));
}

Reply fieldReply(const RequestView& request, const MeshPointer& mesh, Path path) {
  if (path.size() != 3 || path[1] != "chunks") return missingReply("a field has chunks/{n}");
  const auto field = mesh->keys().fieldOfKey(path[0]);
  return field ? chunkReply(request, mesh, path[2], *field)
               : missingReply("this mesh has no field '" + path[0] + "'");
}

}  // namespace

Answer textAnswer(const RequestView& request, const MeshPointer& mesh, ServedMesh::Text which) {
  if (!mesh->isQuick(which)) return Answer(TextRequest{mesh, which});
  return documentReply(request, mesh->text(which), mesh);
}

Answer routeLog(const RequestView& request, const RequestTarget& target, const NamedLog& log) {
  assert(target.segments.size() >= 3);
  const MeshPointer& mesh = log.mesh;
  const Path path = Path(target.segments).subspan(3);
  const std::string what = path.empty() ? "" : path[0];
  if (path.size() == 1 && what == "log")
    return part(request, mesh, "", 0, mesh->log.bytes().size());
  if (path.size() == 1 && what == "base")
    return part(request, mesh, "base", 0, endOf(mesh->log.chunks().front().blocks[kPositionsPart]));
  if (path.size() == 1 && what == "manifest")
    return textAnswer(request, mesh, ServedMesh::Text::kManifest);
  if (path.size() == 1 && what == "poster.webp") return routePoster(request, log);
  if (path.size() == 1 && what == "series") return routeSeries(request, target, log);
  if (path.size() == 2 && what == "chunks") return chunkReply(request, mesh, path[1], std::nullopt);
  if (path.size() == 2 && what == "levels") return routeLevel(request, target, log, path[1]);
  if (path.size() > 1 && what == "fields") return fieldReply(request, mesh, path.subspan(1));
  return missingReply(
      "a log has log, manifest, base, chunks/{n}, fields/{name}/chunks/{n}, levels/{k}.vtu and in "
      "other forms, series, and poster.webp");
}

}  // namespace qtet

#include "simplify/parts/metis_partition.h"

#include <metis.h>

#include <array>
#include <cassert>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace qtet {

namespace {

static_assert(std::is_same_v<idx_t, std::int32_t>);

std::vector<std::uint32_t> partsByMetis(const CellGraph& graph, std::uint32_t parts) {
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  assert(parts >= 2 && !graph.begins.empty());
  assert(graph.weights.size() == graph.beside.size());
  auto vertices = static_cast<idx_t>(graph.begins.size() - 1);
  auto wanted = static_cast<idx_t>(parts);
  idx_t constraints = 1, cut = 0;
  std::vector<idx_t> out(static_cast<std::size_t>(vertices));
  // METIS takes its arrays as writable, and leaves them as they are.
  const auto writable = [](const std::vector<idx_t>& x) { return const_cast<idx_t*>(x.data()); };
  const int done = METIS_PartGraphKway(
      &vertices, &constraints, writable(graph.begins), writable(graph.beside), nullptr, nullptr,
      writable(graph.weights), &wanted, nullptr, nullptr, options.data(), &cut, out.data());
  if (done == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (done != METIS_OK) throw std::runtime_error("METIS failed with " + std::to_string(done));
  return {out.begin(), out.end()};
}

}  // namespace

Partitioner metisPartitioner() { return partsByMetis; }

}  // namespace qtet

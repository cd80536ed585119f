// Series: fields that are the instants of one quantity, called NAME@TIME.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "proto/field_key.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

struct Series {
  std::string name;
  std::vector<std::size_t> fields;  ///< numbers of the instants' fields, by time
  std::vector<double> times;        ///< ascending, as many
};

/// The series of two and more instants, in the order of their first fields. Instants agree in
/// association, components and type; of two with one time the first counts.
template <class Field>
[[nodiscard]] std::vector<Series> seriesOf(std::span<const Field> fields) {
  std::vector<Series> out;
  std::vector<const Field*> firsts;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto name = instantName(fields[f].name);
    if (!name) continue;
    std::size_t s = 0;
    while (s < out.size() &&
           !(out[s].name == name->series && firsts[s]->association == fields[f].association &&
             firsts[s]->components == fields[f].components && firsts[s]->type == fields[f].type))
      ++s;
    if (s == out.size())
      out.push_back({std::string(name->series), {}, {}}), firsts.push_back(&fields[f]);
    const auto at = std::ranges::lower_bound(out[s].times, name->time);
    if (at != out[s].times.end() && *at == name->time) continue;
    out[s].fields.insert(out[s].fields.begin() + (at - out[s].times.begin()), f);
    out[s].times.insert(at, name->time);
  }
  std::erase_if(out, [](const Series& series) { return series.fields.size() < 2; });
  return out;
}

/// Instants of a window: the first is decoded by itself or from the window before. Seeking to an
/// instant takes those of its window that it is predicted from; with more there would be more.
inline constexpr std::size_t kWindow = 8;

/// An instant in the order of decoding, with the instants that come before it and lie around it.
struct InstantStep {
  std::size_t instant;
  /// By time, of its window: the nearest on each side and the next. An anchor has the one before.
  std::vector<std::size_t> around;
  bool isAnchor = false;
};

/// The order in which so many instants are decoded: the ends of a window, and then always the
/// middle between two. Every second instant is a film of half the rate.
[[nodiscard]] std::vector<InstantStep> decodingOrder(std::size_t instants);

/// Puts each series' fields into the order of decoding; other fields keep their places.
void orderSeries(std::vector<MeshField>& fields);

}  // namespace qtet

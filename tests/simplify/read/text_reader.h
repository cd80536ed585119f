// A reader of text files that is given texts.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet::testing {

struct TextReader {
  std::string file;  ///< the name that each text gets
  std::function<Result<CellMesh>(const std::filesystem::path&, ReadReport&)> reader;

  [[nodiscard]] Result<CellMesh> read(const std::string& text, ReadReport& report) const {
    return reader(fileWith(file, text), report);
  }
  [[nodiscard]] Result<CellMesh> read(const std::string& text) const {
    ReadReport report;
    return read(text, report);
  }
  /// The message of the error, which there must be.
  [[nodiscard]] std::string refusalOf(const std::string& text) const {
    const Result<CellMesh> mesh = read(text);
    EXPECT_FALSE(mesh) << text;
    return mesh ? "" : mesh.error().message;
  }
};

}  // namespace qtet::testing

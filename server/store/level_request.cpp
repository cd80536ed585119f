#include "server/store/level_request.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "proto/version.h"
#include "server/wire/digest.h"

namespace qtet {
namespace {

constexpr std::array<std::pair<LevelForm, std::string_view>, 10> kForms = {{
    {LevelForm::kVtu, "vtu"},
    {LevelForm::kVtk, "vtk"},
    {LevelForm::kMsh, "msh"},
    {LevelForm::kObj, "obj"},
    {LevelForm::kGlb, "glb"},
    {LevelForm::kDrc, "drc"},
    {LevelForm::kUsda, "usda"},
    {LevelForm::kWebp, "webp"},
    {LevelForm::kJson, "json"},
    {LevelForm::kCsv, "csv"},
}};

}  // namespace

std::string LevelRequest::key() const {
  std::string text = version() + ' ' + mesh->log.digest() + ' ' + std::to_string(level) + ' ' +
                     std::string(formName(form)) + ' ' + std::string(codingName(coding));
  for (const std::uint32_t field : fields) text += ' ' + std::to_string(field);
  for (const std::string& name : names) text += ' ' + std::to_string(name.size()) + ':' + name;
  if (point)
    for (const double x : *point) text += " @" + std::to_string(std::bit_cast<std::uint64_t>(x));
  return hexDigestOf(text);
}

std::string_view formName(LevelForm form) {
  return std::ranges::find(kForms, form, &std::pair<LevelForm, std::string_view>::first)->second;
}

std::optional<LevelForm> formOfName(std::string_view name) {
  const auto* it = std::ranges::find(kForms, name, &std::pair<LevelForm, std::string_view>::second);
  return it == kForms.end() ? std::nullopt : std::optional(it->first);
}

bool isMeshFile(LevelForm form) {
  switch (form) {
    case LevelForm::kWebp:
    case LevelForm::kJson:
    case LevelForm::kCsv: return false;
    default: return true;
  }
}

}  // namespace qtet

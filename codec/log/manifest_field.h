// A field as the manifest states it and as encoders and meshes have it: the same facts.
#pragma once

#include "codec/mesh/mesh.h"
#include "proto/manifest.h"

namespace qtet {

[[nodiscard]] inline FieldInfo fieldInfoOf(const ManifestField& f) {
  return {f.name, f.components, f.type,  f.association, f.bits,
          f.step, f.minimum,    f.range, f.hasMissing};
}

[[nodiscard]] inline ManifestField manifestFieldOf(const FieldInfo& f) {
  return {f.name, f.components, f.type,  f.association, f.bits,
          f.step, f.minimum,    f.range, f.hasMissing};
}

}  // namespace qtet

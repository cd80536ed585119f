#include "proto/version.h"

namespace qtet {

std::string version() { return QTET_VERSION; }

}  // namespace qtet

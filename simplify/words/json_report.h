// JSON and errors on their way to the user of a command.
#pragma once

#include <nlohmann/json.hpp>

#include "proto/error.h"
#include "simplify/words/console.h"

namespace qtet {

/// Members keep the order in which they are set, which is the order in which people read them.
using OrderedJson = nlohmann::ordered_json;

/// Prints the failure, also as {"error":{"code","message"}} on `out` where JSON was asked for;
/// returns kExitFailed.
int reportFailure(const Error& error, bool asJson, Console& console);

/// Prints one JSON object; bytes that are no UTF-8 are replaced.
void printJson(const OrderedJson& json, Console& console);

}  // namespace qtet

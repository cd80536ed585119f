// Waits for files that another program writes.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/words/console.h"

namespace qtet {

/// Calls `pass` at once, and again when one of the files, or the folder of one, has changed since.
/// It is called again at once where it returned true: there may be more. After an error it is
/// called each time, since what a file names may have to be written first. The same error is
/// reported once. Looks every `interval`. Returns behind the pass in which SIGINT, SIGTERM or
/// SIGHUP has come. A second one ends the program at once.
void followFiles(const std::vector<std::string>& files, std::chrono::milliseconds interval,
                 const std::function<Result<bool>()>& pass, Console& console);

}  // namespace qtet

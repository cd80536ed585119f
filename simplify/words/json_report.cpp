#include "simplify/words/json_report.h"

namespace qtet {

int reportFailure(const Error& error, bool asJson, Console& console) {
  console.err << "qtet: " << console.shown(error.text(), true) << "\n";
  if (asJson)
    printJson({{"error",
                {{"code", errorCodeName(error.code)}, {"message", console.named(error.message)}}}},
              console);
  return kExitFailed;
}

void printJson(const OrderedJson& json, Console& console) {
  console.out << json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) << "\n";
}

}  // namespace qtet
